// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tetskin::scenes {

/// What a command line reads and writes. Looked at before any work: no file that is read is written, and none is
/// written twice. Files are told apart by what they are, whatever they are called: links, ./a and a are one.
class NamedFiles {
 public:
  using IsWritten = std::function<bool(const std::string& name)>;

  /// option  by which the user knows the file; path  empty: none
  void reads(const std::string& option, const std::string& path);
  void writes(const std::string& option, const std::string& path);
  /// A folder, made if need be, in which files of some names are written or removed.
  void writesFolder(const std::string& option, const std::string& path, const IsWritten& isWritten);

  /// Throws InputError for the first of what cannot be, or would be lost. Changes nothing.
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
