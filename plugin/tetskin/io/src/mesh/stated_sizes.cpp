// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/stated_sizes.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_records.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

namespace tetskin::io {

namespace {

Status lies(const std::string& path, const std::string& stated, const std::string& held) {
  return fileError(StatusCode::Malformed, path, 0,
                   "states " + stated + ", but contains " + held + "; is it complete? Save it again");
}

/// A header, on one line or several, consists of the format's name, a dimension if the name begins with n, and three
/// counts. After it, every vertex and every face is a line.
Status checkOff(const std::string& path) {
  const Result<std::string> text = readText(path);
  if (!text.ok()) return text.status();
  TextRecords records(text.value());
  std::vector<std::uint64_t> numbers;
  std::size_t first = 0;  // index of the first count
  TextScanner record = records.next();
  for (; numbers.size() < first + 2; record = records.next()) {
    std::string_view word = record.word();
    if (word.empty()) return {};  // assimp rejects such a file
    for (; !word.empty(); word = record.word()) {
      std::uint64_t number = 0;
      if (parseInteger(word, number)) {
        numbers.push_back(number);
      } else if (word.find("OFF") == word.npos) {
        return fileError(
            StatusCode::Malformed, path, 0,
            "has '" + std::string(word.substr(0, 40)) + "' where a count is expected; write a whole number");
      } else if (word.find("nOFF") != word.npos) {
        first = 1;
      }
    }
  }
  assert(numbers.size() >= first + 2);
  const std::uint64_t vertices = numbers[first], faces = numbers[first + 1];
  std::uint64_t lines = 0;
  for (; !record.word().empty(); record = records.next()) ++lines;
  if (vertices <= lines && faces <= lines - vertices) return {};
  return lies(path, std::to_string(vertices) + " vertices and " + std::to_string(faces) + " faces",
              std::to_string(lines) + " lines of them");
}

/// The first bytes of a file, and how many it has in all; empty if it has fewer.
std::string firstBytes(const std::string& path, std::size_t count, std::uint64_t& size) {
  std::error_code failed;
  size = std::filesystem::file_size(path, failed);
  std::string bytes(count, '\0');
  std::ifstream file(path, std::ios::binary);
  return !failed && file.read(&bytes[0], static_cast<std::streamsize>(count)) ? bytes : std::string();
}

/// 80 bytes of any text, the number of triangles, and 50 bytes per triangle. A text file begins with "solid", as some
/// binary ones do, but contains no zeros.
Status checkBinaryStl(const std::string& path) {
  constexpr std::size_t kHeaderBytes = 84, kTriangleBytes = 50;
  std::uint64_t size = 0;
  const std::string header = firstBytes(path, kHeaderBytes, size);
  const std::size_t word = std::min(header.find_first_not_of(" \t"), header.size());
  if (header.empty() || (header.compare(word, 5, "solid") == 0 && header.find('\0') == header.npos)) return {};
  assert(header.size() == kHeaderBytes && size >= kHeaderBytes);
  const std::uint64_t triangles = bitsAt(&header[80], 4, ByteOrder::Little);
  if (triangles <= (size - kHeaderBytes) / kTriangleBytes) return {};
  return lies(path, std::to_string(triangles) + " triangles, " + std::to_string(kTriangleBytes) + " bytes each",
              std::to_string(size) + " bytes in all");
}

/// Both versions: 4 bytes each for mark, version, length of the file, length of the scene, and its kind; then the
/// scene.
Status checkBinaryGltf(const std::string& path) {
  constexpr std::size_t kHeaderBytes = 20;
  std::uint64_t size = 0;
  const std::string header = firstBytes(path, kHeaderBytes, size);
  if (header.empty()) return {};
  assert(header.size() == kHeaderBytes && size >= kHeaderBytes);
  const std::uint64_t scene = bitsAt(&header[12], 4, ByteOrder::Little);
  if (scene <= size - kHeaderBytes) return {};
  return lies(path, "a scene of " + std::to_string(scene) + " bytes", std::to_string(size) + " bytes in all");
}

}  // namespace

Status checkStatedSizes(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".off") return checkOff(path);
  if (extension == ".stl") return checkBinaryStl(path);
  if (extension == ".glb") return checkBinaryGltf(path);
  return {};
}

}  // namespace tetskin::io
