// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace tetskin::io {

namespace fs = std::filesystem;

namespace {

Status writeBytes(const std::string& name, const std::string& path, std::string_view bytes) {
  errno = 0;
  std::FILE* file = std::fopen(name.c_str(), "wb");
  if (!file) {
    return fileError(StatusCode::FileNotWritable, path, 0,
                     "cannot be created: " + systemReason() + "; check that its folder exists and is writable");
  }
  // Everything is written at once: a buffer would only add a copy.
  std::setvbuf(file, nullptr, _IONBF, 0);
  errno = 0;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  std::string reason = written ? std::string() : systemReason();
  errno = 0;
  const bool closed = std::fclose(file) == 0;
  if (written && closed) return {};
  if (written) reason = systemReason();
  return fileError(StatusCode::FileNotWritable, path, 0,
                   "cannot be written: " + reason + "; free some space or choose another folder");
}

}  // namespace

Status writeFile(const std::string& path, std::string_view bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    return fileError(StatusCode::FileNotWritable, path, 0, "is a folder; give the path of a file");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) return writeBytes(path, path, bytes);

  std::string target = path;
  if (fs::is_symlink(fs::symlink_status(path, error))) {
    const fs::path resolved = fs::weakly_canonical(path, error);
    if (!error) target = resolved.string();
  }
  const std::string part = target + ".part";
  Status written = writeBytes(part, path, bytes);
  if (written.ok()) {
    fs::rename(part, target, error);
    if (!error) return {};
    written = fileError(StatusCode::FileNotWritable, path, 0,
                        "cannot be moved into place: " + error.message() + "; check the permissions of its folder");
  }
  fs::remove(part, error);
  return written;
}

}  // namespace tetskin::io
