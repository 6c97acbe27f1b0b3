// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: triangles of the rest surface, to which points are attached.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/bvh/bvh.h>

#include <vector>

namespace tetskin::touch_detail {

struct NearestTriangle {
  int triangle = -1;                       ///< -1: none
  Eigen::Vector3d weights{1.0, 0.0, 0.0};  ///< barycentric weights of the closest point
  int firstCorner = 0;                     ///< which of its corners is the vertex in question
};

class RestTriangles {
 public:
  RestTriangles() = default;
  /// mesh  indices in range, coordinates finite. Cost O(triangles)
  explicit RestTriangles(const TriangleMesh& mesh);

  /// The triangle with the largest area around a vertex; of equal ones, the lowest number.
  NearestTriangle largestAround(int vertex) const;
  /// The triangle nearest to a point; of equally near ones, the lowest number.
  /// mesh  with triangles, the same as before
  /// tree  of all its triangles
  /// Cost  about O(log n) for n triangles; the first call fits the tree to the mesh at rest, O(n)
  NearestTriangle nearest(const TriangleMesh& mesh, const Bvh& tree, const Eigen::Vector3d& to);

 private:
  std::vector<int> largest_;           ///< by vertex: 3 * triangle + corner; -1: no triangle uses it
  std::vector<BvhBox<double>> boxes_;  ///< by node of the tree, at rest; empty before the first search
};

}  // namespace tetskin::touch_detail
