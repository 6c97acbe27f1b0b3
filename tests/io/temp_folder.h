// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/types.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <random>
#include <string>
#include <system_error>

namespace tetskin::test {

/// A new empty folder, removed with its contents at the end of its scope.
class TempFolder {
 public:
  TempFolder() {
    static std::atomic<unsigned> counter{0};
    const std::string name = "tetskin_io_" + std::to_string(std::random_device{}()) + "_" + std::to_string(++counter);
    root_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(root_);
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string path(const std::string& name = "") const { return (root_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::size_t fileCount() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(root_)) count += entry.is_regular_file();
    return count;
  }

 private:
  std::filesystem::path root_;
};

inline constexpr StatusCode kMalformed = StatusCode::Malformed, kNonFinite = StatusCode::NonFinite,
                            kIndexOutOfRange = StatusCode::IndexOutOfRange,
                            kUnsupportedFormat = StatusCode::UnsupportedFormat,
                            kFileNotFound = StatusCode::FileNotFound, kSizeMismatch = StatusCode::SizeMismatch;

/// The bytes with one to three of them from `first` on set at random.
inline std::string damaged(std::string bytes, std::mt19937& random, std::size_t first = 0) {
  for (unsigned k = 0; k <= random() % 3; ++k) {
    bytes[first + random() % (bytes.size() - first)] = static_cast<char>(random() % 256);
  }
  return bytes;
}

/// Expects the status to have this code, and its message to contain all these strings.
inline void expectError(const Status& status, StatusCode code, std::initializer_list<std::string> components) {
  EXPECT_STREQ(toString(status.code), toString(code)) << status.message;
  for (const std::string& part : components) {
    EXPECT_NE(status.message.find(part), std::string::npos) << "'" << part << "' is not in: " << status.message;
  }
}
template <class Value>
void expectError(const Result<Value>& result, StatusCode code, std::initializer_list<std::string> components) {
  expectError(result.status(), code, components);
}

}  // namespace tetskin::test
