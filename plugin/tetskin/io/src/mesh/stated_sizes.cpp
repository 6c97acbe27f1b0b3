// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/stated_sizes.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace tetskin::io {

namespace {

Status lies(const std::string& path, const std::string& stated, const std::string& held) {
  return fileError(StatusCode::Malformed, path, 0,
                   "states " + stated + ", but contains " + held + "; is it complete? Save it again");
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

/// Of version 1: 4 bytes each for mark, version, length of the file, length of the scene, and its kind; then the
/// scene.
Status checkBinaryGltf(const std::string& path) {
  constexpr std::size_t kHeaderBytes = 20;
  std::uint64_t size = 0;
  const std::string header = firstBytes(path, kHeaderBytes, size);
  if (header.compare(0, 4, "glTF") != 0) return {};
  assert(header.size() == kHeaderBytes && size >= kHeaderBytes);
  const std::uint64_t scene = bitsAt(&header[12], 4, ByteOrder::Little);
  if (scene <= size - kHeaderBytes) return {};
  return lies(path, "a scene of " + std::to_string(scene) + " bytes", std::to_string(size) + " bytes in all");
}

}  // namespace

Status checkStatedSizes(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".stl") return checkBinaryStl(path);
  if (extension == ".glb" || extension == ".gltf") return checkBinaryGltf(path);
  return {};
}

}  // namespace tetskin::io
