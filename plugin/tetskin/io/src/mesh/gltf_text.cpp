// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/gltf_text.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tetskin::io {

namespace {

/// Header sizes of the file and of its chunks: glTF 2.0 specification, 4.4.
constexpr std::size_t kGlbHeaderBytes = 12, kChunkHeaderBytes = 8;
/// The types of chunks: "JSON" and "BIN" in ASCII.
constexpr std::uint64_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
/// A document is 8 levels deep, without extras and extensions.
constexpr int kMaxDepth = 100;
constexpr std::array<std::string_view, 10> kShape = {
    "asset",  "extensionsUsed", "extensionsRequired", "bufferViews", "accessors", "meshes", "nodes",
    "scenes", "scene",          "materials"};

std::uint64_t wordAt(const std::string& bytes, std::size_t at) {
  assert(at + 4 <= bytes.size());
  return bitsAt(&bytes[at], 4, ByteOrder::Little);
}

/// The index of the quote that ends a string, or the text's size.
std::size_t stringEnd(std::string_view json, std::size_t begin) {
  assert(json[begin] == '"');
  for (std::size_t i = begin + 1; i < json.size(); ++i) {
    if (json[i] == '"') return i;
    if (json[i] == '\\') ++i;
  }
  return json.size();
}

/// Renames a member of the document, in place.
/// begin, end  the quotes around its name
void renameMember(std::string& json, std::size_t begin, std::size_t end) {
  assert(begin < end && end < json.size());
  const std::string_view name = std::string_view(json).substr(begin + 1, end - begin - 1);
  if (std::find(kShape.begin(), kShape.end(), name) != kShape.end()) return;
  if (name == "buffers") {
    json.replace(begin, 9, "\"extras\" ");
  } else {
    std::fill(json.begin() + static_cast<std::ptrdiff_t>(begin) + 1, json.begin() + static_cast<std::ptrdiff_t>(end),
              'x');
  }
}

}  // namespace

Result<GltfText> splitGltf(const std::string& path, std::string bytes) {
  GltfText text;
  if (bytes.compare(0, 4, "glTF") != 0) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n", bytes.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0);
    if (first == std::string::npos || bytes[first] != '{') {
      return fileError(StatusCode::Malformed, path, 0,
                       "is not glTF 2.0, which begins with 'glTF' (GLB) or with '{' (text); export the model again");
    }
    text.json = std::move(bytes);
    return text;
  }
  const auto malformed = [&](const std::string& what) {
    return fileError(StatusCode::Malformed, path, 0, what + "; is it complete? Save it again");
  };
  if (bytes.size() < kGlbHeaderBytes + kChunkHeaderBytes) return malformed("ends within the header of a GLB");
  text.firstVersion = wordAt(bytes, 4) == 1;
  if (text.firstVersion) return text;
  std::size_t at = kGlbHeaderBytes;
  while (at + kChunkHeaderBytes <= bytes.size() && !text.binary) {
    const std::uint64_t length = wordAt(bytes, at), kind = wordAt(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (length > bytes.size() - at) {
      return malformed("states a chunk of " + std::to_string(length) + " bytes, but contains " +
                       std::to_string(bytes.size() - at) + " of them");
    }
    if (text.json.empty() && kind == kJsonChunk) text.json = bytes.substr(at, static_cast<std::size_t>(length));
    if (kind == kBinaryChunk) text.binary = bytes.substr(at, static_cast<std::size_t>(length));
    at += static_cast<std::size_t>(length);
  }
  if (text.json.empty()) return malformed("has no text in its first chunk");
  return text;
}

Status keepShape(const std::string& path, GltfText& text) {
  std::string& json = text.json;
  int depth = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '}' || c == ']') --depth;
    if ((c == '{' || c == '[') && ++depth > kMaxDepth) {
      return fileError(StatusCode::Malformed, path, 0,
                       "has values inside values more than " + std::to_string(kMaxDepth) +
                           " deep; remove the extras, or export the model again");
    }
    if (c != '"') continue;
    const std::size_t end = stringEnd(json, i);
    const std::size_t next = json.find_first_not_of(" \t\r\n", end + 1);
    if (depth == 1 && next < json.size() && json[next] == ':') {
      const std::size_t value = json.find_first_not_of(" \t\r\n", next + 1);
      if (value < json.size() && json[value] == '{' && json.compare(i, 8, "\"meshes\"") == 0) text.firstVersion = true;
      renameMember(json, i, end);
    }
    i = std::max(i, end);
  }
  return {};
}

}  // namespace tetskin::io
