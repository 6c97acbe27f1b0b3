// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>

namespace tetskin::io {

/// Reads an STL file, binary or text, as it stands there: three vertices for every triangle, in the file's order. Its
/// normals are left out, as those of the triangles are known.
///
/// Cost: linear; memory is bounded by the size of the file.
///
/// Errors: as `loadMesh`.
Result<TriangleMesh> readStl(const std::string& path);

}  // namespace tetskin::io
