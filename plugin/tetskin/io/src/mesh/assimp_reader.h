// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>

namespace tetskin::io {

/// Reads any format that assimp reads, as `loadMesh` describes. In a build without assimp: UnsupportedFormat, if there
/// is such a file. Throws nothing.
Result<TriangleMesh> readWithAssimp(const std::string& path);

}  // namespace tetskin::io
