// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace tetskin::io {

/// A file that is written in pieces, under the name `path.part` until it is complete, so that a file called `path` is
/// always complete: an interrupted run leaves the earlier one, or none, and perhaps a `.part`. It writes through
/// symbolic links, and directly to anything that is not a regular file (/dev/stdout). It does not wait for the disk, so
/// a power failure may lose the file. Can be moved, not copied; without `finish`, it removes the `.part`.
class AtomicFile {
 public:
  AtomicFile() = default;
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;

  /// Errors: FileNotWritable.
  static Result<AtomicFile> create(const std::string& path);

  /// Appends bytes. Error: FileNotWritable; the `.part` is then removed.
  Status append(std::string_view bytes);
  /// Replaces bytes that were written before; the file must be replaceable. Errors as for `append`.
  Status overwrite(long offset, std::string_view bytes);
  /// Closes the file, and gives it its name. Errors as for `append`.
  Status finish();

  /// False for anything but a regular file, which is written directly, from beginning to end.
  bool replaceable() const { return part_ != target_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Status put(std::string_view bytes);
  Status fail(const std::string& reason);
  void discard();

  std::string path_;    ///< as given, for messages
  std::string target_;  ///< after following links
  std::string part_;    ///< the file that is written: the target itself if it is not a regular file
  std::unique_ptr<std::FILE, Close> file_;
};

/// Writes a whole file, as an AtomicFile does.
/// Errors: FileNotWritable; the `.part` is removed.
Status writeFile(const std::string& path, std::string_view bytes);

}  // namespace tetskin::io
