// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "scenes/input_error.h"

namespace tetskin::scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* kNotWritable = ": cannot be written; does its folder exist?";

bool write(const std::string& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  return file.good();
}

/// True if a file can be written under another name and renamed: it is a regular file, or does not exist.
bool isReplaceable(fs::file_type type) {
  return type == fs::file_type::not_found || type == fs::file_type::regular;
}

}  // namespace

void writeFile(const std::string& path, std::string_view bytes) {
  std::error_code error;
  if (!isReplaceable(fs::status(path, error).type())) {
    if (!write(path, bytes)) throw InputError(path + kNotWritable);
    return;
  }
  const bool link = fs::is_symlink(fs::symlink_status(path, error));
  const fs::path target = link ? fs::weakly_canonical(path, error) : fs::path(path);
  const std::string part = target.string() + ".part";
  bool done = write(part, bytes);
  if (done) {
    fs::rename(part, target, error);
    done = !error;
  }
  if (done) return;
  fs::remove(part, error);
  throw InputError(path + kNotWritable);
}

std::string sizeText(double bytes) {
  constexpr double kKilo = 1e3, kMega = 1e6;
  char text[48];
  if (bytes < kMega) {
    std::snprintf(text, sizeof text, "%.0f kB", std::ceil(bytes / kKilo));
  } else {
    std::snprintf(text, sizeof text, "%.*f MB", bytes < 10 * kMega ? 1 : 0, bytes / kMega);
  }
  return text;
}

fs::path existingComponent(fs::path folder) {
  std::error_code error;
  folder = fs::absolute(folder, error);
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

void requireWritable(const std::string& path) {
  std::error_code none;
  const fs::file_type before = fs::status(path, none).type();
  // /dev/stdout or a pipe: must not be touched before the output begins.
  if (!isReplaceable(before) && before != fs::file_type::directory) return;
  if (!std::ofstream(path, std::ios::app)) throw InputError(path + kNotWritable);
  if (before == fs::file_type::not_found) fs::remove(fs::canonical(path, none), none);  // not the link to it
}

void requireExtension(const std::string& path, const std::vector<std::string>& extensions) {
  std::string extension = fs::path(path).extension().string(), known;
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extensions.empty() || std::count(extensions.begin(), extensions.end(), extension) > 0) return;
  for (const std::string& one : extensions) {
    known += (known.empty() ? "" : &one == &extensions.back() ? " or " : ", ") + one;
  }
  throw InputError(path + ": unsupported output format; use " + known);
}

}  // namespace tetskin::scenes
