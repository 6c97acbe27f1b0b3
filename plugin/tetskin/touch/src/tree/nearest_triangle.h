// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: searches for triangles of the rest surface that visit all of them.
#pragma once

#include <tetskin/core/mesh.h>

namespace tetskin::touch_detail {

struct NearestTriangle {
  int triangle = -1;                       ///< -1: none
  Eigen::Vector3d weights{1.0, 0.0, 0.0};  ///< barycentric weights of the closest point
  int firstCorner = 0;                     ///< which of its corners is the vertex that was asked for
};

/// The triangle nearest to a point. It tests all triangles: it is called once per point that is attached, and a
/// hierarchy at rest would be kept for that purpose alone.
/// mesh  with triangles. Cost O(triangles)
NearestTriangle nearestTriangle(const TriangleMesh& mesh, const Eigen::Vector3d& to);

/// The triangle with the largest area around a vertex.
NearestTriangle largestAround(const TriangleMesh& mesh, int vertex);

}  // namespace tetskin::touch_detail
