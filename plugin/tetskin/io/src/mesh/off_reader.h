// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>

namespace tetskin::io {

/// Reads an OFF file of text without changes: every vertex in the file's order; polygons cut into triangles, faces of
/// fewer than three corners left out; normals of an NOFF file. What stands behind the coordinates of a vertex and the
/// corners of a face (colours, texture coordinates) is ignored.
///
/// Cost: linear, but for concave polygons (see `appendPolygon`); memory is bounded by the size of the file.
///
/// Errors: as `loadMesh`; the message names the line.
Result<TriangleMesh> readOff(const std::string& path);

}  // namespace tetskin::io
