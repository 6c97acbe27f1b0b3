// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <string>

namespace tetskin {

/// Reads a render mesh.
///
/// `.obj` files (in any case) are read as they are: vertices in the file's order, also unused ones; polygons cut into
/// triangles; groups by `g`, `o` and `usemtl`; texture coordinates and normals if every vertex has one of its own.
///
/// `.ply` files likewise: no groups, normals and texture coordinates if the file has them.
///
/// Everything else (STL, glTF, FBX, Collada, 3DS, OFF, ...) is read by assimp, as it stands in its scene:
/// - every mesh once for each node that shows it, transformed, as one group; in the file's own unit;
/// - vertices are those of assimp (three a triangle for STL), none joined; those of lines and points are left out, and
///   so are bones and animations;
/// - where only some of the meshes have texture coordinates, the others get 0; where only some have normals, the others
///   get smooth ones, weighted by area. Normals are unit, or 0 where the file's are useless.
///
/// Errors: FileNotFound, UnsupportedFormat, Malformed, IndexOutOfRange, NonFinite (also for a coordinate beyond
/// kLargestCoordinate), and Empty if there are no vertices or no triangles. The message names the file, and the line of
/// an `.obj` or an ASCII `.ply` file. Throws nothing.
TETSKIN_IO_API Result<TriangleMesh> loadMesh(const std::string& path);

}  // namespace tetskin
