// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/named_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/system.h"

namespace tetskin::scenes {

namespace fs = std::filesystem;

namespace {

/// Files that are read or written because another one is named.
constexpr std::pair<const char*, const char*> kCompanions[] = {
    {".ele", ".node"}, {".node", ".ele"}, {".obj", ".mtl"}, {".gltf", ".bin"}};

/// The target of a path, followed up to the first component that does not exist.
fs::path target(fs::path path) {
  constexpr int kMaxLinks = 40;
  std::error_code error;
  path = fs::absolute(path, error);
  for (int k = 0; k < kMaxLinks && fs::is_symlink(fs::symlink_status(path, error)); ++k) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  return fs::weakly_canonical(path, error);
}

/// True unless it is a device or a pipe, to which several may write.
bool isFile(const fs::path& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  return type == fs::file_type::regular || type == fs::file_type::not_found;
}

bool isSame(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (!isFile(a) || !isFile(b)) return false;
  return fs::equivalent(a, b, error) || target(a) == target(b);
}

std::vector<std::string> withCompanion(const std::string& path) {
  std::vector<std::string> all = {path};
  for (const auto& [extension, companion] : kCompanions) {
    if (fs::path(path).extension() == extension) all.push_back(fs::path(path).replace_extension(companion).string());
  }
  return all;
}

/// True if writing one file affects the other, also under the temporary name that it has while it is written.
bool touches(const std::string& written, const std::string& other) {
  for (const std::string& w : withCompanion(written)) {
    for (const std::string& o : withCompanion(other)) {
      if (isSame(w, o) || isSame(w + ".part", o)) return true;
    }
  }
  return false;
}

void requireFolder(const std::string& path) {
  const fs::path there = existingComponent(path);
  std::error_code error;
  if (!fs::is_directory(there, error)) {
    throw InputError(path + ": cannot be created: " + there.string() + " is a file, not a folder");
  }
  if (!mayWriteInto(there)) throw InputError(path + ": the folder cannot be written to; check its permissions");
}

fs::path folderOf(const std::string& path) {
  return target(path).parent_path();
}

}  // namespace

void NamedFiles::reads(const std::string& option, const std::string& path) {
  if (!path.empty()) inputs_.push_back({option, path});
}

void NamedFiles::writes(const std::string& option, const std::string& path) {
  if (!path.empty()) outputs_.push_back({option, path});
}

void NamedFiles::writesFolder(const std::string& option, const std::string& path, const IsWritten& isWritten) {
  if (!path.empty()) folders_.push_back({{option, path}, isWritten});
}

void NamedFiles::check() const {
  for (const File& file : inputs_) requireFile(file);
  for (const Folder& folder : folders_) requireFolder(folder.file.path);
  requireApart();
  for (const Folder& folder : folders_) {
    for (const auto* files : {&inputs_, &outputs_}) {
      for (const File& file : *files) requireOutside(folder, file);
    }
  }
  for (const File& file : outputs_) requireWritable(file);
}

void NamedFiles::requireApart() const {
  for (auto out = outputs_.begin(); out != outputs_.end(); ++out) {
    for (const File& in : inputs_) {
      if (!touches(out->path, in.path)) continue;
      throw InputError(out->option + " " + out->path + ": would overwrite the input of " + in.option + " " + in.path +
                       "; choose another name");
    }
    for (auto other = outputs_.begin(); other != out; ++other) {
      if (!touches(out->path, other->path) && !touches(other->path, out->path)) continue;
      throw InputError(out->option + " " + out->path + ": would overwrite the output of " + other->option +
                       "; choose another name");
    }
  }
}

/// A pipe cannot be read twice, and blocks until somebody writes to it.
void NamedFiles::requireFile(const File& file) {
  std::error_code error;
  if (!fs::is_fifo(fs::status(file.path, error))) return;
  throw InputError(file.option + " " + file.path + ": is a pipe; a file is required");
}

/// A file is in the folder by its name there, or by a link there that leads to it.
void NamedFiles::requireOutside(const Folder& folder, const File& file) const {
  std::error_code error;
  bool within = target(folder.file.path) == folderOf(file.path) &&
                folder.isWritten(target(file.path).filename().string()) && isFile(file.path);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.file.path, error)) {
    within = within || (folder.isWritten(entry.path().filename().string()) && isSame(entry.path(), file.path));
  }
  if (!within) return;
  throw InputError(file.option + " " + file.path + ": would be overwritten by the output of " + folder.file.option +
                   " " + folder.file.path + "; choose another name, or another folder");
}

void NamedFiles::requireWritable(const File& file) const {
  const auto isMade = [&](const Folder& folder) { return target(folder.file.path) == folderOf(file.path); };
  std::error_code error;
  const bool willBe = !fs::exists(folderOf(file.path), error) && std::any_of(folders_.begin(), folders_.end(), isMade);
  if (!willBe) scenes::requireWritable(file.path);
}

}  // namespace tetskin::scenes
