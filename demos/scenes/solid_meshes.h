// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces of boxes and balls: closed and welded, their triangles of about one size.
#pragma once

#include <tetskin/core/mesh.h>

namespace tetskin::scenes {

/// The surface of a box of unit cubes with a corner at the origin, and a grid of these as its vertices.
TriangleMesh gridBox(const Eigen::Vector3i& cubes);

/// The surface of a box about the origin, its faces divided into squares.
/// divisions  of its longest edge; the other edges should be as many whole squares long
TriangleMesh boxOfGrids(const Eigen::Vector3d& halfExtents, int divisions);

/// A sphere of radius 1 about the origin: an icosahedron divided `level` times, of 10 x 4^level + 2 vertices.
TriangleMesh icosphere(int level);

}  // namespace tetskin::scenes
