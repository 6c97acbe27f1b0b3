// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/tree/nearest_triangle.h>

#include <algorithm>
#include <limits>

namespace tetskin::touch_detail {
namespace {

using Eigen::Vector3d;

Vector3d placeOfCorner(const TriangleMesh& mesh, std::size_t triangle, int k) {
  return mesh.positions[static_cast<std::size_t>(mesh.triangles[triangle][static_cast<std::size_t>(k)])];
}

/// Weights of the nearest of three sides' points.
Vector3d onSides(const Vector3d p[3], const Vector3d& to) {
  Vector3d best(1.0, 0.0, 0.0);
  double nearest = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const Vector3d side = p[b] - p[a];
    const double length = side.squaredNorm();
    const double at = length > 0.0 ? std::clamp((to - p[a]).dot(side) / length, 0.0, 1.0) : 0.0;
    const double squared = (p[a] + at * side - to).squaredNorm();
    if (squared >= nearest) continue;
    nearest = squared;
    best.setZero();
    best[a] = 1.0 - at;
    best[b] = at;
  }
  return best;
}

Vector3d nearestWeights(const Vector3d p[3], const Vector3d& to) {
  const Vector3d first = p[1] - p[0], second = p[2] - p[0], normal = first.cross(second);
  const double area = normal.squaredNorm();
  if (!(area > 0.0)) return onSides(p, to);
  const double u = (to - p[0]).cross(second).dot(normal) / area, v = first.cross(to - p[0]).dot(normal) / area;
  if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) return {1.0 - u - v, u, v};
  return onSides(p, to);
}

}  // namespace

NearestTriangle nearestTriangle(const TriangleMesh& mesh, const Vector3d& to) {
  NearestTriangle best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3d p[3] = {placeOfCorner(mesh, t, 0), placeOfCorner(mesh, t, 1), placeOfCorner(mesh, t, 2)};
    const Vector3d w = nearestWeights(p, to);
    const double squared = (w[0] * p[0] + w[1] * p[1] + w[2] * p[2] - to).squaredNorm();
    if (squared >= nearest) continue;
    nearest = squared;
    best.triangle = static_cast<int>(t);
    best.weights = w;
  }
  return best;
}

NearestTriangle largestAround(const TriangleMesh& mesh, int vertex) {
  NearestTriangle best;
  double largest = -1.0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles[t][static_cast<std::size_t>(k)] != vertex) continue;
      const Vector3d a = placeOfCorner(mesh, t, 0);
      const double area = (placeOfCorner(mesh, t, 1) - a).cross(placeOfCorner(mesh, t, 2) - a).norm();
      if (area <= largest) continue;
      largest = area;
      best.triangle = static_cast<int>(t);
      best.firstCorner = k;
    }
  }
  return best;
}

}  // namespace tetskin::touch_detail
