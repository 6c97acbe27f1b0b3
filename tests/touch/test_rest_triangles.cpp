// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which triangle a point is attached to: as a search through all of them finds it.
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/mesh/triangle_geometry.h>
#include <tetskin/touch/src/tree/nearest_triangle.h>

#include <limits>

namespace tetskin::test {
namespace {

using touch_detail::NearestTriangle;
using touch_detail::RestTriangles;

NearestTriangle nearestOfAll(const TriangleMesh& mesh, const Eigen::Vector3d& to) {
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

NearestTriangle largestOfAll(const TriangleMesh& mesh, int vertex) {
  NearestTriangle best;
  double largest = -1.0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto& [a, b, c] = cornersOf(mesh, mesh.triangles[t]);
      const double area = (b - a).cross(c - a).norm();
      if (mesh.triangles[t][static_cast<std::size_t>(k)] != vertex || area <= largest) continue;
      largest = area;
      best.triangle = static_cast<int>(t);
      best.firstCorner = k;
    }
  }
  return best;
}

Bvh treeOf(const TriangleMesh& mesh) {
  Bvh::Centroids<double> centroids;
  for (const auto& t : mesh.triangles) {
    const TriangleCorners corners = cornersOf(mesh, t);
    centroids.emplace_back(corners[0] + corners[1] + corners[2]);
  }
  return Bvh(centroids, 4);
}

/// A ball, some of whose triangles are there twice, flat, or points, with a vertex that no triangle uses.
TriangleMesh oddBall() {
  TriangleMesh mesh = sphere(10, 1.0, {0.3, -0.2, 5.0});
  for (int t = 0; t < 20; ++t) mesh.triangles.push_back(mesh.triangles[static_cast<std::size_t>(3 * t)]);
  mesh.triangles.push_back({4, 5, 4});
  mesh.triangles.push_back({7, 7, 7});
  mesh.positions.emplace_back(9.0, 9.0, 9.0);
  return mesh;
}

TEST(RestTriangles, FindsTheNearestAsASearchThroughAllDoes) {
  const TriangleMesh mesh = oddBall();
  const Bvh tree = treeOf(mesh);
  RestTriangles triangles(mesh);
  std::vector<Eigen::Vector3d> points = mesh.positions;  // on them, many triangles are equally near
  for (const auto& t : mesh.triangles) {
    const TriangleCorners c = cornersOf(mesh, t);
    points.push_back((c[0] + c[1]) / 2.0);
    points.push_back((c[0] + c[1] + c[2]) / 3.0);
  }
  for (const double size : {2.0, 20.0, 2e8}) {
    const Box3 box(Eigen::Vector3d::Constant(-size), Eigen::Vector3d::Constant(size));
    for (const Eigen::Vector3d& p : randomPoints(200, box, 7)) points.push_back(p);
  }
  for (const Eigen::Vector3d& p : points) {
    const NearestTriangle found = triangles.nearest(mesh, tree, p), wanted = nearestOfAll(mesh, p);
    EXPECT_EQ(found.triangle, wanted.triangle) << p.transpose();
    EXPECT_EQ(found.weights, wanted.weights) << p.transpose();
    EXPECT_EQ(found.firstCorner, 0);
  }
}

TEST(RestTriangles, FindsTheLargestAroundAVertexAsASearchThroughAllDoes) {
  const TriangleMesh mesh = oddBall();
  const RestTriangles triangles(mesh);
  const auto count = static_cast<int>(mesh.vertexCount());
  for (int v = -1; v <= count; ++v) {
    const NearestTriangle found = triangles.largestAround(v), wanted = largestOfAll(mesh, v);
    EXPECT_EQ(found.triangle, wanted.triangle) << v;
    EXPECT_EQ(found.firstCorner, wanted.firstCorner) << v;
  }
  EXPECT_EQ(triangles.largestAround(count - 1).triangle, -1);
}

}  // namespace
}  // namespace tetskin::test
