// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>

namespace tetskin::io {

/// Why this build cannot read or write glTF: it was made without tinygltf. Empty if it can.
std::string whyNoGltf();

/// Reads a `.gltf`, `.glb` or `.vrm` file as `loadMesh` describes. Throws nothing. Defined only if `whyNoGltf` is
/// empty.
Result<TriangleMesh> readGltf(const std::string& path);

}  // namespace tetskin::io
