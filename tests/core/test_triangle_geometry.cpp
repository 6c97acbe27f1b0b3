// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/mesh/triangle_samples.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

const Box3 kAroundTriangles(Vector3d(-2, -2, -2), Vector3d(2, 2, 2));

Vector3d pointOf(const ClosestPoint& closest, const TriangleCorners& t) {
  return closest.weights[0] * t[0] + closest.weights[1] * t[1] + closest.weights[2] * t[2];
}

/// Distance to the nearest of many sampled points of the triangle.
double sampledDistance(const Vector3d& p, const TriangleCorners& t) {
  constexpr int kDivisions = 200;
  double minimum = HUGE_VAL;
  forEachSample(kDivisions, [&](int i, int j, int k) {
    minimum = std::min(minimum, ((i * t[0] + j * t[1] + k * t[2]) / kDivisions - p).norm());
  });
  return minimum;
}

TEST(ClosestPointOnTriangle, CoversItsSevenRegions) {
  const Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const auto closest = [&](double x, double y) { return closestPointOnTriangle(Vector3d(x, y, 2), a, b, c).point; };
  EXPECT_EQ(closest(-1, -1), a);
  EXPECT_EQ(closest(3, -1), b);
  EXPECT_EQ(closest(-1, 3), c);
  EXPECT_EQ(closest(0.25, -1), Vector3d(0.25, 0, 0));
  EXPECT_EQ(closest(-1, 0.25), Vector3d(0, 0.25, 0));
  EXPECT_LT((closest(1, 1) - Vector3d(0.5, 0.5, 0)).norm(), 1e-15);
  EXPECT_LT((closest(0.2, 0.3) - Vector3d(0.2, 0.3, 0)).norm(), 1e-15);
}

TEST(ClosestPointOnTriangle, IsAsNearAsAnyPointOfIt) {
  const std::vector<Vector3d> corners = randomPoints(90, kAroundTriangles, 1),
                              points = randomPoints(30, kAroundTriangles, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TriangleCorners t = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    const ClosestPoint closest = closestPointOnTriangle(points[i], t);
    const double distance = (closest.point - points[i]).norm(), sampled = sampledDistance(points[i], t);
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_NEAR(distance, sampled, 0.03);
    EXPECT_LT((pointOf(closest, t) - closest.point).norm(), 1e-13) << "by its weights";
    EXPECT_GE(closest.weights.minCoeff(), 0.0);
    EXPECT_NEAR(closest.weights.sum(), 1.0, 1e-15);
  }
}

TEST(ClosestPointOnTriangle, IsThatOfTheSidesWhereThereIsNoArea) {
  const std::vector<Vector3d> ends = randomPoints(60, kAroundTriangles, 3),
                              points = randomPoints(30, kAroundTriangles, 4);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d &a = ends[2 * i], &b = ends[2 * i + 1];
    const double along = std::min(std::max((points[i] - a).dot(b - a) / (b - a).squaredNorm(), 0.0), 1.0);
    const double expected = (a + along * (b - a) - points[i]).norm();
    for (const TriangleCorners& t : {TriangleCorners{a, b, a}, {a, a, b}, {b, a, a}, {a, 0.5 * (a + b), b}}) {
      const ClosestPoint closest = closestPointOnTriangle(points[i], t);
      EXPECT_NEAR((closest.point - points[i]).norm(), expected, 1e-12);
      EXPECT_LT((pointOf(closest, t) - closest.point).norm(), 1e-13);
    }
    EXPECT_EQ(closestPointOnTriangle(points[i], a, a, a).point, a);
  }
}

TEST(TriangleSamples, AreNoFartherApartThanTheSpacing) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(edgeDivisions(mesh, {0, 1, 2}, 3.0), 1.0);
  EXPECT_EQ(edgeDivisions(mesh, {0, 1, 2}, 0.5), 5.0);  // the longest edge is 2.24
  int count = 0;
  forEachSample(5, [&](int i, int j, int k) {
    EXPECT_EQ(i + j + k, 5);
    EXPECT_GE(std::min({i, j, k}), 0);
    ++count;
  });
  EXPECT_EQ(count, 21);
}

}  // namespace
}  // namespace tetskin::test
