// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/deepest_vertex.h"

#include <tetskin/core/src/base/mesh/triangle_geometry.h>

#include "scenes/bar.h"

namespace tetskin {
namespace {

using Eigen::Vector3d;
using scenes::DeepestVertex;
using scenes::deepestVertex;

/// A cube from -1 to 1 along each axis.
TriangleMesh makeCube() {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.positions.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A tetrahedron that stands on its tip.
TriangleMesh standingOn(const Vector3d& tip) {
  TriangleMesh mesh;
  mesh.positions = {tip, tip + Vector3d(1, 1, 1), tip + Vector3d(-1, 1, 1), tip + Vector3d(0, 1, -1)};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return mesh;
}

/// The solid angles of all triangles, divided by that of a full sphere (van Oosterom and Strackee 1983).
double windingNumber(const TriangleMesh& mesh, const Vector3d& p) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    auto [a, b, c] = cornersOf(mesh, triangle);
    a -= p, b -= p, c -= p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * EIGEN_PI);
}

double distanceTo(const TriangleMesh& mesh, const Vector3d& p) {
  double minimum = HUGE_VAL;
  for (const auto& triangle : mesh.triangles) {
    const auto [a, b, c] = cornersOf(mesh, triangle);
    minimum = std::min(minimum, (closestPointOnTriangle(p, a, b, c).point - p).norm());
  }
  return minimum;
}

TEST(DeepestVertex, IsTheDistanceToTheNearestTriangleOfTheOtherBody) {
  const DeepestVertex deepest = deepestVertex({makeCube(), standingOn({0.3, 0.9, 0.1})});
  EXPECT_NEAR(deepest.depth, 0.1, 1e-12);
  EXPECT_EQ(deepest.body, 1u);
  EXPECT_EQ(deepest.vertex, 0);
  EXPECT_EQ(deepest.other, 0u);
  EXPECT_EQ(deepest.count, 1u);
}

TEST(DeepestVertex, IsNoneOfBodiesThatAreApart) {
  for (const auto& surfaces :
       {std::vector<TriangleMesh>{makeCube(), standingOn({0.3, 1.0 + 1e-6, 0.1})}, {makeCube()}, {}}) {
    const DeepestVertex deepest = deepestVertex(surfaces);
    EXPECT_EQ(deepest.depth, 0.0);
    EXPECT_EQ(deepest.vertex, -1);
    EXPECT_EQ(deepest.count, 0u);
  }
}

TEST(DeepestVertex, IsThatOfEveryVertexAgainstAllTriangles) {
  std::vector<TriangleMesh> bars(3, scenes::makeBar(2000));
  const Eigen::AngleAxisd turn(1.0, Vector3d(0.2, 1.0, 0.3).normalized());
  for (Vector3d& p : bars[1].positions) p = turn * p + Vector3d(0.1, 0.7, 0.2);
  for (Vector3d& p : bars[2].positions) p = turn * turn * p + Vector3d(-0.2, 0.3, 0.9);
  double depth = 0.0;
  std::size_t count = 0;
  for (std::size_t body = 0; body < bars.size(); ++body) {
    for (std::size_t other = 0; other < bars.size(); ++other) {
      if (body == other) continue;
      for (const Vector3d& p : bars[body].positions) {
        if (windingNumber(bars[other], p) <= 0.5) continue;
        ++count;
        depth = std::max(depth, distanceTo(bars[other], p));
      }
    }
  }
  const DeepestVertex deepest = deepestVertex(bars);
  EXPECT_GT(count, 50u);
  EXPECT_EQ(deepest.count, count);
  EXPECT_NEAR(deepest.depth, depth, 1e-12);
}

}  // namespace
}  // namespace tetskin
