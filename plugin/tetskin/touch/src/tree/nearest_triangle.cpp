// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/tree/nearest_triangle.h>

#include <tetskin/core/src/shared/mesh/triangle_geometry.h>

#include <cassert>
#include <limits>

namespace tetskin::touch_detail {

NearestTriangle nearestTriangle(const TriangleMesh& mesh, const Eigen::Vector3d& to) {
  assert(mesh.triangleCount() > 0);
  NearestTriangle best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const ClosestPoint closest = closestPointOnTriangle(to, cornersOf(mesh, mesh.triangles[t]));
    const double squared = (closest.point - to).squaredNorm();
    if (squared >= nearest) continue;
    nearest = squared;
    best.triangle = static_cast<int>(t);
    best.weights = closest.weights;
  }
  return best;
}

NearestTriangle largestAround(const TriangleMesh& mesh, int vertex) {
  NearestTriangle best;
  double largest = -1.0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles[t][static_cast<std::size_t>(k)] != vertex) continue;
      const auto& [a, b, c] = cornersOf(mesh, mesh.triangles[t]);
      const double area = (b - a).cross(c - a).norm();
      if (area <= largest) continue;
      largest = area;
      best.triangle = static_cast<int>(t);
      best.firstCorner = k;
    }
  }
  return best;
}

}  // namespace tetskin::touch_detail
