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

/// The two parts of a glTF file.
struct GltfText {
  std::string json;
  std::optional<std::string> binary;  ///< the binary chunk of a GLB
  bool firstVersion = false;          ///< the file is glTF 1.0, and was not split, or not reduced
};

/// Splits the bytes of a `.gltf` or a `.glb` file, which differ in how they begin. Error: Malformed
Result<GltfText> splitGltf(const std::string& path, std::string bytes);

/// Reduces a glTF document to its shape, for a parser that passes extras on unchanged, opens files that the document
/// names, and recurses per level. Renames the member `buffers` to `extras`, and all members that do not affect the
/// shape (images, textures, cameras, animations, the file's own extras) to names that glTF does not have. Notes if its
/// meshes are not a list, as in glTF 1.0. Anything that is not JSON is left to the parser. Error: Malformed for values
/// nested more than 100 deep
Status keepShape(const std::string& path, GltfText& text);

}  // namespace tetskin::io
