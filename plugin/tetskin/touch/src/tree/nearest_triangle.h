// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: triangles of the rest surface, by all of them.
#pragma once

#include <tetskin/core/triangle_mesh.h>

namespace tetskin::touch_detail {

struct NearestTriangle {
  int triangle = -1;                       ///< -1: none
  Eigen::Vector3d weights{1.0, 0.0, 0.0};  ///< of its corners, where it is nearest
  int firstCorner = 0;                     ///< which of its corners was asked for
};

/// A scan, since it is asked for once a point that is attached, and a hierarchy at rest would be kept for it alone.
/// mesh  with triangles. Cost O(triangles)
NearestTriangle nearestTriangle(const TriangleMesh& mesh, const Eigen::Vector3d& to);

/// The one of largest area around a vertex.
NearestTriangle largestAround(const TriangleMesh& mesh, int vertex);

}  // namespace tetskin::touch_detail
