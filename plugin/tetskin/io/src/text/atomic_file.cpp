// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>

#include <cassert>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace tetskin::io {

namespace fs = std::filesystem;

AtomicFile::~AtomicFile() {
  discard();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      part_(std::move(other.part_)),
      file_(std::move(other.file_)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  path_ = std::move(other.path_);
  target_ = std::move(other.target_);
  part_ = std::move(other.part_);
  file_ = std::move(other.file_);
  return *this;
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    return fileError(StatusCode::FileNotWritable, path, 0, "is a folder; give the path of a file");
  }
  AtomicFile made;
  made.path_ = made.target_ = made.part_ = path;
  if (!fs::exists(status) || fs::is_regular_file(status)) {
    if (fs::is_symlink(fs::symlink_status(path, error))) {
      const fs::path resolved = fs::weakly_canonical(path, error);
      if (!error) made.target_ = resolved.string();
    }
    made.part_ = made.target_ + ".part";
  }
  errno = 0;
  made.file_.reset(std::fopen(made.part_.c_str(), "wb"));
  if (!made.file_) {
    return fileError(StatusCode::FileNotWritable, path, 0,
                     "cannot be created: " + systemReason() + "; check that its folder exists and is writable");
  }
  // Large pieces are written at once: a buffer would only add a copy.
  std::setvbuf(made.file_.get(), nullptr, _IONBF, 0);
  return made;
}

void AtomicFile::discard() {
  if (!file_) return;
  file_.reset();
  if (!replaceable()) return;
  std::error_code ignored;
  fs::remove(part_, ignored);
}

Status AtomicFile::fail(const std::string& reason) {
  discard();
  return fileError(StatusCode::FileNotWritable, path_, 0,
                   "cannot be written: " + reason + "; free some space or choose another folder");
}

Status AtomicFile::put(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return fail(systemReason());
  return {};
}

Status AtomicFile::append(std::string_view bytes) {
  assert(file_);
  return put(bytes);
}

Status AtomicFile::overwrite(long offset, std::string_view bytes) {
  assert(file_ && replaceable());
  errno = 0;
  if (std::fseek(file_.get(), offset, SEEK_SET) != 0) return fail(systemReason());
  Status status = put(bytes);
  if (status.ok() && std::fseek(file_.get(), 0, SEEK_END) != 0) return fail(systemReason());
  return status;
}

Status AtomicFile::finish() {
  assert(file_);
  std::error_code error;
  errno = 0;
  if (std::fclose(file_.release()) != 0) {
    const std::string reason = systemReason();
    if (replaceable()) fs::remove(part_, error);
    return fail(reason);
  }
  if (!replaceable()) return {};
  fs::rename(part_, target_, error);
  if (!error) return {};
  const std::string reason = error.message();
  fs::remove(part_, error);
  return fileError(StatusCode::FileNotWritable, path_, 0,
                   "cannot be moved into place: " + reason + "; check the permissions of its folder");
}

Status writeFile(const std::string& path, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) return file.status();
  Status status = file.value().append(bytes);
  return status.ok() ? file.value().finish() : status;
}

}  // namespace tetskin::io
