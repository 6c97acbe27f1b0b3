// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/triangle_geometry.h>
#include <tetskin/touch/src/tree/nearest_triangle.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::touch_detail {
namespace {

/// What rounding may add to a box's distance, relative to the largest coordinate. Without it, if the point lies on an
/// edge or a vertex, the search would miss those of the triangles around it whose boxes seem farther away.
constexpr double kRounding = 1e-14;

}  // namespace

RestTriangles::RestTriangles(const TriangleMesh& mesh) : largest_(mesh.vertexCount(), -1) {
  std::vector<double> areas(mesh.vertexCount(), -1.0);
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const auto& [a, b, c] = cornersOf(mesh, mesh.triangles[t]);
    const double area = (b - a).cross(c - a).norm();
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][static_cast<std::size_t>(k)]);
      if (area <= areas[vertex]) continue;
      areas[vertex] = area;
      largest_[vertex] = 3 * static_cast<int>(t) + k;
    }
  }
}

NearestTriangle RestTriangles::largestAround(int vertex) const {
  NearestTriangle found;
  if (vertex < 0 || static_cast<std::size_t>(vertex) >= largest_.size()) return found;
  const int largest = largest_[static_cast<std::size_t>(vertex)];
  if (largest < 0) return found;
  found.triangle = largest / 3;
  found.firstCorner = largest % 3;
  return found;
}

NearestTriangle RestTriangles::nearest(const TriangleMesh& mesh, const Bvh& tree, const Eigen::Vector3d& to) {
  assert(!tree.empty() && tree.items().size() == mesh.triangleCount());
  const auto corners = [&](int index) {
    return cornersOf(mesh, mesh.triangles[static_cast<std::size_t>(tree.item(index))]);
  };
  if (boxes_.empty()) {
    tree.fit(boxes_, [&](int index) {
      BvhBox<double> box;
      for (const Eigen::Vector3d& p : corners(index)) box.extend(p.data());
      return box;
    });
  }
  NearestTriangle best;
  double nearest = std::numeric_limits<double>::infinity();
  tree.visitNear(boxes_, to, nearest, [&](int index, double& bound) {
    const ClosestPoint closest = closestPointOnTriangle(to, corners(index));
    const double squared = (closest.point - to).squaredNorm();
    const int triangle = tree.item(index);
    if (squared > nearest || (squared == nearest && triangle > best.triangle)) return;
    nearest = squared;
    best.triangle = triangle;
    best.weights = closest.weights;
    const double largest = std::max(to.cwiseAbs().maxCoeff(), closest.point.cwiseAbs().maxCoeff());
    const double within = std::sqrt(squared) + kRounding * largest;
    bound = within * within;
  });
  return best;
}

}  // namespace tetskin::touch_detail
