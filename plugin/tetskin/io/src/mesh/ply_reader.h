// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>

namespace tetskin::io {

/// Reads a PLY file, ASCII or binary of either byte order, without changes: every vertex in the file's order; polygons
/// and triangle strips cut into triangles, faces of fewer than three corners left out; normals (nx, ny, nz), and
/// texture coordinates of vertices (s t, u v or texture_u texture_v), or of faces' corners (texcoord) if every vertex
/// has one of its own.
///
/// Cost: linear, but for concave polygons (see `appendPolygon`); memory is bounded by the size of the file, whatever
/// counts it states.
///
/// Errors: as `loadMesh`. Messages of ASCII files name the line.
Result<TriangleMesh> readPly(const std::string& path);

}  // namespace tetskin::io
