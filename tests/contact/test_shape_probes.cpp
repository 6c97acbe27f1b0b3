// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/solver/src/search/convex_probe.h>
#include <tetskin/solver/src/search/hull_probe.h>
#include <tetskin/solver/src/search/mesh_probe.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

/// Unsigned distance to a mesh, by testing all triangles.
double bruteDistance(const TriangleMesh& mesh, const btVector3& point) {
  double minimum = HUGE_VAL;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d p = toEigen(point);
    minimum = std::min(minimum, (closestPointOnTriangle(p, cornersOf(mesh, t)).point - p).norm());
  }
  return minimum;
}

/// Whether a point is inside a convex mesh.
bool isInside(const TriangleMesh& mesh, const btVector3& point) {
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    if ((b - a).cross(c - a).dot(toEigen(point) - a) > 0.0) return false;
  }
  return true;
}

/// Asks as a search does: first for a ball, then for a smaller ball in it around the point.
ShapeDistance asked(ShapeProbe& probe, const btVector3& point, btScalar reach) {
  const NodePath path{point, point};
  if (!probe.enter({point + btVector3(btScalar(0.05), 0, 0), btScalar(0.1)}, reach)) return {};
  if (!probe.narrow({&path, 1, 1}, {point, btScalar(0.01)}, reach)) return {};
  EXPECT_LE(probe.bound()(point), btFabs(probe.at(point).distance) + btScalar(1e-4));
  return probe.at(point);
}

TEST(HullProbe, FindsTheDistanceOfAllTriangles) {
  const TriangleMesh ball = ballMesh(8, 1.0);
  btConvexHullShape hull;
  for (const Eigen::Vector3d& p : ball.positions) hull.addPoint(toBullet(p));
  HullProbe probe;
  ASSERT_TRUE(probe.take(hull));
  int near = 0;
  for (const btVector3& point : pointsWithin(btScalar(1.2), 2000)) {
    const ShapeDistance found = asked(probe, point, btScalar(0.1));
    const double brute = bruteDistance(ball, point);
    if (found.distance > btScalar(0.1)) {
      EXPECT_GT(brute, 0.0995);
      continue;
    }
    ++near;
    EXPECT_NEAR(std::abs(static_cast<double>(found.distance)), brute, 4e-4);  // Bullet rounds hulls to a grid
    if (brute > 4e-4) {
      EXPECT_EQ(found.distance > 0, !isInside(ball, point));
    }
  }
  EXPECT_GT(near, 500);
}

TEST(HullProbe, SeesThatAHullHasChanged) {
  btConvexHullShape hull;
  for (const Eigen::Vector3d& p : boxMesh(Eigen::Vector3d(1, 1, 1)).positions) hull.addPoint(toBullet(p));
  HullProbe probe;
  ASSERT_TRUE(probe.take(hull));
  EXPECT_NEAR(asked(probe, btVector3(0, btScalar(1.05), 0), 1).distance, 0.05, 1e-5);
  hull.setLocalScaling(btVector3(1, btScalar(0.5), 1));
  ASSERT_TRUE(probe.take(hull));
  EXPECT_NEAR(asked(probe, btVector3(0, btScalar(1.05), 0), 1).distance, 0.55, 1e-5);
}

TEST(HullProbe, MakesFacesOnceAsLongAsTheyAreKept) {
  std::vector<std::unique_ptr<btConvexHullShape>> hulls;
  std::vector<std::shared_ptr<const HullFaces>> kept;
  HullProbe probe;
  for (int k = 0; k < 200; ++k) {
    hulls.push_back(std::make_unique<btConvexHullShape>());
    for (const Eigen::Vector3d& p : boxMesh({1, 1, 1.0 + k}).positions) hulls.back()->addPoint(toBullet(p));
    ASSERT_TRUE(probe.take(*hulls.back()));
    kept.push_back(probe.faces());
  }
  for (std::size_t k = 0; k < hulls.size(); ++k) {
    ASSERT_TRUE(probe.take(*hulls[k]));
    EXPECT_EQ(probe.faces(), kept[k]);
  }
  const std::weak_ptr<const HullFaces> first = kept[0];
  kept.clear();
  EXPECT_TRUE(first.expired());
}

TEST(HullProbe, LeavesFlatHullsToOthers) {
  btConvexHullShape hull;
  for (int k = 0; k < 4; ++k) hull.addPoint(btVector3(k & 1, 0, k / 2));
  HullProbe probe;
  EXPECT_FALSE(probe.take(hull));
}

TEST(ConvexProbe, FindsTheDistanceOfAHullsFacesOnBothSides) {
  btConvexHullShape hull;
  for (const Eigen::Vector3d& p : ballMesh(6, 1.0).positions) hull.addPoint(toBullet(p));
  HullProbe faces;
  ASSERT_TRUE(faces.take(hull));
  ConvexProbe gjk;
  gjk.take(hull);
  for (const btVector3& point : pointsWithin(btScalar(1.1), 300)) {
    const ShapeDistance exact = asked(faces, point, 2), found = asked(gjk, point, 2);
    EXPECT_NEAR(found.distance, exact.distance, 5e-3);
    if (exact.distance > btScalar(0.02)) {
      EXPECT_GT(found.normal.dot(exact.normal), 0.95);  // Bullet's normals are off by ten degrees near an edge
    }
  }
}

/// Triangles beyond the reach also decide, if others are within the thickness, but behind.
TEST(MeshProbe, APointBesideAThinMeshIsNotInsideOfItsOtherSide) {
  const TriangleMesh ball = ballMesh(12, 0.03);
  btTriangleMesh mesh;
  for (const auto& t : ball.triangles) {
    mesh.addTriangle(toBullet(ball.positions[t[0]]), toBullet(ball.positions[t[1]]), toBullet(ball.positions[t[2]]));
  }
  const btBvhTriangleMeshShape shape(&mesh, true);
  MeshProbe probe;
  probe.take(shape, btScalar(0.1));
  constexpr btScalar kReach = btScalar(0.001);
  int outside = 0, inside = 0;
  for (const btVector3& point : pointsWithin(btScalar(0.05), 3000)) {
    const ShapeDistance found = asked(probe, point, kReach);
    const double brute = bruteDistance(ball, point);
    if (brute < 1e-4) continue;
    const bool within = isInside(ball, point);
    EXPECT_EQ(found.distance < 0, within) << point.length();
    if (within || brute < static_cast<double>(kReach)) {
      EXPECT_NEAR(std::abs(static_cast<double>(found.distance)), brute, 1e-4);
    } else {
      EXPECT_GE(found.distance, kReach * btScalar(0.999));
      EXPECT_LE(found.distance, static_cast<btScalar>(brute) + btScalar(1e-5));
    }
    ++(within ? inside : outside);
  }
  EXPECT_GT(outside, 1000);
  EXPECT_GT(inside, 200);
}

TEST(MeshProbe, FindsTheDistanceOfAllTrianglesAndTheSide) {
  const TriangleMesh ball = ballMesh(12, 1.0);
  btTriangleMesh mesh;
  for (const auto& t : ball.triangles) {
    mesh.addTriangle(toBullet(ball.positions[t[0]]), toBullet(ball.positions[t[1]]), toBullet(ball.positions[t[2]]));
  }
  const btBvhTriangleMeshShape shape(&mesh, true);
  MeshProbe probe;
  probe.take(shape, btScalar(0.1));
  int outside = 0, inside = 0;
  for (const btVector3& point : pointsWithin(btScalar(1.2), 3000)) {
    const ShapeDistance found = asked(probe, point, btScalar(0.1));
    const double brute = bruteDistance(ball, point);
    if (brute > 0.0999) {
      EXPECT_GE(found.distance, 0.0999);
      continue;
    }
    EXPECT_NEAR(std::abs(static_cast<double>(found.distance)), brute, 1e-4);
    // The ball's triangles face outwards.
    ++(found.distance > 0 ? outside : inside);
    if (brute > 4e-4) {
      EXPECT_EQ(found.distance > 0, !isInside(ball, point));
    }
    EXPECT_GT(found.normal.dot(point.normalized()), 0.8);
  }
  EXPECT_GT(outside, 200);
  EXPECT_GT(inside, 200);
}

}  // namespace
}  // namespace tetskin::test
