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

Status notWritten(const std::string& path, const std::string& what) {
  return fileError(StatusCode::FileNotWritable, path, 0, what);
}

/// Where links lead.
std::string targetOf(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
  const fs::path resolved = fs::weakly_canonical(path, error);
  return error ? path : resolved.string();
}

/// What is written: another name of the target's, or the target itself if it is no regular file.
struct Part {
  std::string target, path;
  std::FILE* file = nullptr;

  bool isRenamed() const { return path != target; }
};

Result<Part> begin(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return notWritten(path, "is a folder; give the path of a file");
  Part part{path, path};
  if (!fs::exists(status) || fs::is_regular_file(status)) {
    part.target = targetOf(path);
    part.path = part.target + ".part";
  }
  errno = 0;
  part.file = std::fopen(part.path.c_str(), "wb");
  if (part.file) return part;
  return notWritten(path, "cannot be created: " + systemReason() + "; check that its folder exists and is writable");
}

/// Writes all bytes, and closes the file. Returns why it could not; empty if it could.
std::string writeAll(std::FILE* file, std::string_view bytes) {
  std::setvbuf(file, nullptr, _IONBF, 0);  // a buffer would only add a copy
  errno = 0;
  std::string reason;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size()) reason = systemReason();
  if (std::fclose(file) != 0 && reason.empty()) reason = systemReason();
  return reason;
}

}  // namespace

Status checkWritable(const std::string& path) {
  const Result<Part> begun = begin(path);
  if (!begun.ok()) return begun.status();
  std::fclose(begun.value().file);
  std::error_code ignored;
  if (begun.value().isRenamed()) fs::remove(begun.value().path, ignored);
  return {};
}

Status writeFile(const std::string& path, std::string_view bytes) {
  const Result<Part> begun = begin(path);
  if (!begun.ok()) return begun.status();
  const Part& part = begun.value();
  std::error_code error;
  std::string fault = writeAll(part.file, bytes);
  if (!fault.empty()) {
    fault = "cannot be written: " + fault + "; free some space or choose another folder";
  } else if (part.isRenamed()) {
    fs::rename(part.path, part.target, error);
    if (error) fault = "cannot be moved into place: " + error.message() + "; check the permissions of its folder";
  }
  if (fault.empty()) return {};
  if (part.isRenamed()) fs::remove(part.path, error);
  return notWritten(path, fault);
}

}  // namespace tetskin::io
