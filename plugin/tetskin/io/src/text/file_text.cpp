// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

namespace tetskin::io {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

Result<std::string> readFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return fileError(StatusCode::FileNotFound, path, 0, "is a folder; give the path of a file");
  }
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    return fileError(StatusCode::FileNotFound, path, 0,
                     "cannot be opened: " + systemReason() + "; check the path and its permissions");
  }
  std::string bytes;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (!ignored) bytes.reserve(static_cast<std::size_t>(size) + 1);
  // Number of bytes to read at a time.
  constexpr std::size_t kChunk = std::size_t(1) << 20;
  for (std::size_t got = kChunk; got == kChunk;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    got = std::fread(&bytes[before], 1, kChunk, file.get());
    bytes.resize(before + got);
  }
  if (std::ferror(file.get()) != 0) {
    return fileError(StatusCode::FileNotFound, path, 0, "cannot be read: " + systemReason() + "; check the disk");
  }
  return bytes;
}

Result<std::string> readText(const std::string& path) {
  Result<std::string> text = readFile(path);
  if (!text.ok()) return text;
  return withLineFeeds(std::move(text).value());
}

std::string withLineFeeds(std::string text) {
  if (text.find('\r') == text.npos) return text;
  bool beforeFeed = false;
  for (auto c = text.rbegin(); c != text.rend(); ++c) {
    if (*c != '\r') {
      beforeFeed = *c == '\n';
    } else if (!beforeFeed) {
      *c = '\n';
    }
  }
  return text;
}

Status fileError(StatusCode code, const std::string& path, std::size_t line, const std::string& what) {
  const std::string name = path.empty() ? "(empty path)" : path;
  return {code, name + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": " + what};
}

std::string lowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

std::string excerpt(std::string_view text, std::size_t most) {
  std::string result(text.substr(0, most));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return "'" + result + (text.size() > most ? "...'" : "'");
}

std::string systemReason() {
  return std::generic_category().message(errno);
}

}  // namespace tetskin::io
