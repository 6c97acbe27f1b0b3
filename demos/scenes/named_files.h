// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tetskin::scenes {

/// The files that a command line reads and writes. They are checked before any work: no file that is read may be
/// written, and none may be written twice. Files are identified by the file itself, not by name: a link, ./a and a may
/// be the same file.
class NamedFiles {
 public:
  using IsWritten = std::function<bool(const std::string& name)>;

  /// option  by which the user knows the file; path  empty: no file
  void reads(const std::string& option, const std::string& path);
  void writes(const std::string& option, const std::string& path);
  /// A folder, made if it does not exist, in which files with certain names are written or removed.
  void writesFolder(const std::string& option, const std::string& path, const IsWritten& isWritten);

  /// Throws InputError for the first file that cannot be read or written, or would be lost. Changes nothing.
  void check() const;

 private:
  struct File {
    std::string option, path;
  };
  struct Folder {
    File file;
    IsWritten isWritten;
  };
  static void requireFile(const File& file);
  void requireApart() const;
  void requireOutside(const Folder& folder, const File& file) const;
  void requireWritable(const File& file) const;

  std::vector<File> inputs_, outputs_;
  std::vector<Folder> folders_;
};

}  // namespace tetskin::scenes
