// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   "glTF 2.0 Specification", Khronos Group, 2021
#pragma once

#include <tetskin/core/types.h>

#include <optional>
#include <string>

namespace tetskin::io {

/// The two pieces of a glTF file.
struct GltfText {
  std::string json;
  std::optional<std::string> binary;  ///< the binary chunk of a GLB
  bool firstVersion = false;          ///< of glTF 1.0: not split, or not reduced
};

/// Splits the bytes of a `.gltf` or a `.glb` file, told apart by how they begin. Error: Malformed
Result<GltfText> splitGltf(const std::string& path, std::string bytes);

/// Reduces a glTF document to its shape, for a parser that gives extras as they are, opens what it is told of, and
/// calls itself for each level: renames the members `buffers`, to `extras`, and all that tell of no shape (images,
/// textures, cameras, animations, the file's own extras), to names that glTF does not have. Notes if its meshes are no
/// list, as in glTF 1.0. What is no JSON stays as it is, up to the parser. Error: Malformed for values inside values
/// more than 100 deep
Status keepShape(const std::string& path, GltfText& text);

}  // namespace tetskin::io
