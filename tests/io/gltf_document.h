// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Makes glTF files, piece by piece.
#pragma once

#include "loaded_texts.h"
#include "raw_bytes.h"

#include <tetskin/io/files.h>

#include <cstdint>
#include <string>

namespace tetskin::test {

/// Types of numbers.
namespace gltf_types {
constexpr int kSignedByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsigned = 5125,
              kFloat = 5126;
}  // namespace gltf_types

/// A document of one buffer, made piece by piece.
struct Document {
  std::string bytes, views, accessors, moreBuffers;
  int viewCount = 0, accessorCount = 0;

  /// Adds a separate view. Returns its number.
  int view(const std::string& data, int stride = 0) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    views += (viewCount > 0 ? "," : "") + std::string(R"({"buffer":0,"byteLength":)") + std::to_string(data.size()) +
             R"(,"byteOffset":)" + std::to_string(bytes.size()) +
             (stride > 0 ? R"(,"byteStride":)" + std::to_string(stride) : std::string()) + "}";
    bytes += data;
    return viewCount++;
  }
  /// view  -1: none
  int accessor(int view, int type, int count, const std::string& kind, const std::string& more = "") {
    accessors += (accessorCount > 0 ? ",{" : "{") +
                 (view < 0 ? std::string() : R"("bufferView":)" + std::to_string(view) + ",") + R"("componentType":)" +
                 std::to_string(type) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" + kind + "\"" + more +
                 "}";
    return accessorCount++;
  }
  int accessor(const std::string& data, int type, int count, const std::string& kind, const std::string& more = "") {
    return accessor(view(data), type, count, kind, more);
  }
  /// rest  members of the document, such as `meshOf`
  /// uri   of the buffer
  std::string json(const std::string& rest, const std::string& uri = embedded,
                   const std::string& nodes = R"({"mesh":0})") const {
    const std::string source = uri == embedded ? "data:application/octet-stream;base64," + base64(bytes) : uri;
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]," + rest +
           R"(,"accessors":[)" + accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[{"byteLength":)" +
           std::to_string(bytes.size()) + (uri == inChunk ? "" : R"(,"uri":")" + source + "\"") + "}" + moreBuffers +
           "]}";
  }
  /// after  bytes that follow the chunks
  std::string glb(const std::string& rest, const std::string& after = "") const {
    std::string text = json(rest, inChunk), binary = bytes;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto size = [](const std::string& chunk) { return static_cast<std::uint32_t>(chunk.size()); };
    return "glTF" + raw<std::uint32_t>({2, 28 + size(text) + size(binary) + size(after), size(text)}) + "JSON" + text +
           raw<std::uint32_t>({size(binary)}) + std::string("BIN\0", 4) + binary + after;
  }
  Result<TriangleMesh> load(const std::string& rest, const std::string& uri = embedded,
                            const std::string& nodes = R"({"mesh":0})") const {
    return loadMeshText("m.gltf", json(rest, uri, nodes));
  }
  Result<TriangleMesh> loadGlb(const std::string& rest, const std::string& after) const {
    return loadMeshText("m.glb", glb(rest, after));
  }
  inline static const std::string embedded = "(in the document)", inChunk = "(in a chunk)";
};

inline std::string primitive(int positions, int indices, const std::string& more = "") {
  return R"({"attributes":{"POSITION":)" + std::to_string(positions) + "}" +
         (indices < 0 ? std::string() : R"(,"indices":)" + std::to_string(indices)) + more + "}";
}

inline std::string meshOf(const std::string& primitives) {
  return R"("meshes":[{"primitives":[)" + primitives + "]}]";
}

/// One triangle; its positions are accessor 0.
inline Document triangle() {
  Document document;
  document.accessor(raw<float>({0, 0, 0, 2, 0, 0, 0, 1, 0}), gltf_types::kFloat, 3, "VEC3");
  return document;
}

}  // namespace tetskin::test
