// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <tiny_gltf.h>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::io {

/// The numbers that a glTF document describes. Everything that it states is checked against the actual bytes. Buffers
/// are read when a number in them is first needed. The path, the model and the chunk must outlive it.
class GltfAccessors {
 public:
  /// model  parsed from the result of `keepShape`: its extras are the document's buffers
  GltfAccessors(const std::string& path, const tinygltf::Model& model, const std::optional<std::string>& binaryChunk)
      : path_(path), model_(model), binaryChunk_(binaryChunk) {}

  /// Reads the numbers of an accessor; normalised integers become fractions of their largest value.
  /// arity   numbers per element: 1 to 4
  /// Errors  Malformed, IndexOutOfRange; FileNotFound and UnsupportedFormat for a buffer
  Status read(int accessor, int arity, std::vector<double>& numbers);

  Status error(StatusCode code, const std::string& what) const;
  /// A status that names an extension, and the cure.
  Status needs(const std::string& extension) const;

 private:
  /// Elements in a row, in the bytes of a buffer.
  struct Elements {
    int view = 0;
    std::uint64_t offset = 0;  ///< in the view
    int component = 0;         ///< its type, as glTF names it
    std::uint64_t arity = 1, count = 0;
    bool packed = false;  ///< ignores the view's stride
  };
  template <class Take>
  Status readElements(const Elements& elements, Take&& take);
  Status viewBytes(int view, std::string_view& bytes);
  Status bufferBytes(int buffer, std::string_view& bytes);
  Status addSparse(const tinygltf::Accessor& accessor, std::uint64_t arity, std::vector<double>& numbers);

  const std::string& path_;
  const tinygltf::Model& model_;
  const std::optional<std::string>& binaryChunk_;
  std::map<int, std::string> buffers_;  ///< those read so far
};

}  // namespace tetskin::io
