// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <tetskin/solver/src/search/hull_probe.h>
#include <tetskin/solver/src/search/mesh_probe.h>
#include <tetskin/solver/src/search/point_path.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr btScalar kKept = btScalar(0.002), kReach = btScalar(0.005);
/// Half the sides of a tile with its upper side at y = 0.
const btVector3 kTile(1, btScalar(0.1), 1);

/// Counts how often it is asked.
class CountingProbe : public ExactProbe {
 public:
  ShapeDistance at(const btVector3& point) const override {
    ++asked;
    return ExactProbe::at(point);
  }
  mutable int asked = 0;
};

/// A point near the upper side of the tile.
btVector3 overTile(double x, double height) {
  return btVector3(static_cast<btScalar>(x), kTile.y() + static_cast<btScalar>(height), 0);
}

/// How much nearer than the margin the plane says that the path's end is; 0: it is not in the way.
btScalar violation(const PathState& state, const NodePath& path) {
  return btMax(kKept - heightAbove(state, path.predicted), btScalar(0));
}

class PointPathTest : public ::testing::Test {
 protected:
  PointPathTest() {
    const btBoxShape box(kTile);
    tile_.take(*ExactShape::exactShape(box));
  }
  /// The state that decides; the first one within reach must be there.
  static PathState decided(const ShapeProbe& probe, const NodePath& path) {
    const PathState met = firstInReach(probe, path, kReach);
    EXPECT_LT(met.distance.distance, BT_LARGE_FLOAT);
    return decidingState(probe, path, kKept, kReach, met);
  }

  CountingProbe tile_;
};

/// Along a row of tiles, the edge of the next one comes within reach from aside.
TEST_F(PointPathTest, AnEdgeThatAPathCrossesOnTheLevelIsNotInItsWay) {
  for (const double height : {0.002, 0.0019, 0.0022}) {
    for (const double side : {-1.0, 1.0}) {
      const NodePath path{overTile(side * 1.004, height), overTile(side * 0.992, height - 0.0001)};
      EXPECT_GT(btFabs(firstInReach(tile_, path, kReach).distance.normal.x()), 0.8);
      const PathState state = decided(tile_, path);
      EXPECT_GT(state.distance.normal.y(), 0.9999);
      EXPECT_NEAR(heightAbove(state, path.predicted), height - 0.0001, 1e-6);
    }
  }
}

/// On a wavy surface, a point rises ahead of what slides over it, and goes by below it.
TEST_F(PointPathTest, APathThatGoesByBeyondTheMarginTouchesNothing) {
  constexpr btScalar kNarrow = btScalar(1.1) * kKept;
  const auto reach = static_cast<double>(kNarrow);
  for (const double rise : {0.0, 2e-5, 1e-4}) {
    const NodePath path{overTile(1.0005, 1.03 * reach), overTile(0.9925, 1.03 * reach + rise)};
    const PathState met = firstInReach(tile_, path, kNarrow);
    EXPECT_GT(violation(met, path), 1e-4);
    EXPECT_EQ(decidingState(tile_, path, kKept, kNarrow, met).distance.distance, btScalar(BT_LARGE_FLOAT));
  }
}

/// A path that ends before the edge, on the level of the upper side: its plane is inclined by a little, and in the way
/// by a thousandth of the margin.
TEST_F(PointPathTest, AnEdgeThatAPathApproachesOnTheLevelIsHardlyInItsWay) {
  for (const double end : {1.0001, 1.0005, 1.001}) {
    const NodePath path{overTile(1.005, 0.002), overTile(end, 0.002)};
    EXPECT_LT(violation(decided(tile_, path), path), 1e-3 * kKept) << end;
  }
}

TEST_F(PointPathTest, ACornerThatAPathPassesByIsNotInItsWay) {
  int turned = 0;
  for (double height = 0.0021; height < 0.005; height += 0.0002) {
    for (double slope = -0.3; slope < 0.35; slope += 0.1) {
      const NodePath path{overTile(1.01, height + 0.01 * slope), overTile(0.99, height - 0.01 * slope)};
      btScalar nearest = BT_LARGE_FLOAT;
      for (int k = 0; k <= 1000; ++k) {
        nearest = btMin(nearest, tile_.at(path.now.lerp(path.predicted, btScalar(k) / 1000)).distance);
      }
      if (nearest < kKept || nearest > kReach * btScalar(0.9)) continue;
      const PathState state = decided(tile_, path);
      EXPECT_LT(violation(state, path), 0.01 * kKept) << height << " " << slope;
      turned += heightAbove(state, path.now) > kKept * btScalar(0.99);
    }
  }
  EXPECT_GT(turned, 20);
}

TEST_F(PointPathTest, ACornerThatAPathLeadsIntoIsInItsWay) {
  for (const btVector3& direction : {btVector3(-1, -1, 0), btVector3(-1, btScalar(-0.2), 0), btVector3(-1, -3, 0)}) {
    const btVector3 corner(kTile.x(), kTile.y(), 0), along = btScalar(0.01) * direction.normalized();
    const NodePath path{corner - along, corner + along};
    const PathState state = decided(tile_, path);
    EXPECT_GT(violation(state, path), 0.01);
    EXPECT_GT(state.distance.normal.dot(-along), 0);
  }
}

/// Points that rest, fall or are pressed on hardly move sideways.
TEST_F(PointPathTest, ARestingPointIsAskedForOnce) {
  for (const btVector3& motion : {btVector3(0, btScalar(-0.0001), 0), btVector3(btScalar(0.0001), btScalar(-0.001), 0),
                                  btVector3(btScalar(0.003), btScalar(0.0001), 0)}) {
    const NodePath path{overTile(0.3, 0.0021), overTile(0.3, 0.0021) + motion};
    tile_.asked = 0;
    const PathState state = decided(tile_, path);
    EXPECT_EQ(tile_.asked, 1);
    EXPECT_EQ(state.where, path.now);
  }
}

TEST_F(PointPathTest, AThinPlateThatAPathPassesThroughIsInItsWay) {
  const btBoxShape box(btVector3(1, btScalar(0.0005), 1));
  ExactProbe plate;
  plate.take(*ExactShape::exactShape(box));
  for (const btScalar aside : {btScalar(0), btScalar(0.02), btScalar(0.1)}) {
    const NodePath path{btVector3(0, btScalar(0.02), 0), btVector3(aside, btScalar(-0.004), 0)};
    const PathState state = decided(plate, path);
    EXPECT_GT(state.distance.normal.y(), 0.9999);
    EXPECT_GT(violation(state, path), 0.003);
  }
}

/// Levels of a mesh, each a square about the origin, wound upwards.
class LevelsProbe {
 public:
  explicit LevelsProbe(const std::vector<double>& heights) {
    for (const double y : heights) {
      const auto corner = [&](int x, int z) { return btVector3(btScalar(x), static_cast<btScalar>(y), btScalar(z)); };
      mesh_.addTriangle(corner(-1, -1), corner(-1, 1), corner(1, -1));
      mesh_.addTriangle(corner(1, -1), corner(-1, 1), corner(1, 1));
    }
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
    probe_.take(*shape_, btScalar(0.01));
  }
  const ShapeProbe& enter(const NodePath& path) {
    const btVector3 centre = (path.now + path.predicted) * btScalar(0.5);
    EXPECT_TRUE(probe_.enter({centre, (path.now - centre).length()}, kReach + (path.now - centre).length() * 2));
    return probe_;
  }

 private:
  btTriangleMesh mesh_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  MeshProbe probe_;
};

TEST_F(PointPathTest, ATableIsInTheWayOfAPathThatEndsOnTheShelfBelow) {
  LevelsProbe levels({0.0, -0.1});
  for (const double below : {-0.099, -0.097, -0.05}) {
    const NodePath path{btVector3(0, btScalar(0.01), 0), btVector3(btScalar(0.05), static_cast<btScalar>(below), 0)};
    const PathState state = decided(levels.enter(path), path);
    EXPECT_GT(violation(state, path), 0.05);
    EXPECT_NEAR(heightAbove(state, btVector3(0, 0, 0)), 0, 1e-5);
  }
}

TEST_F(PointPathTest, AnInnerEdgeOfAMeshIsNotInTheWay) {
  LevelsProbe levels({0.0});
  for (const double from : {-0.004, 0.0, 0.004}) {  // about the diagonal
    const NodePath path{btVector3(static_cast<btScalar>(from), btScalar(0.002), 0),
                        btVector3(static_cast<btScalar>(from) + btScalar(0.012), btScalar(0.0019), 0)};
    const PathState state = decided(levels.enter(path), path);
    EXPECT_GT(state.distance.normal.y(), 0.9999);
    EXPECT_NEAR(heightAbove(state, path.predicted), 0.0019, 1e-6);
  }
}

/// In all cases the space behind the plane contains the convex shape: no point that stays in front of the plane enters
/// it.
TEST_F(PointPathTest, TheShapeIsBehindThePlaneThatDecides) {
  const TriangleMesh ball = ballMesh(4, 0.05);
  btConvexHullShape hull;
  for (const Eigen::Vector3d& p : ball.positions) hull.addPoint(toBullet(p));
  HullProbe probe;
  ASSERT_TRUE(probe.take(hull));
  const std::vector<btVector3> points = pointsWithin(btScalar(0.07), 4000);
  int passing = 0, entering = 0;
  for (std::size_t k = 0; k + 1 < points.size(); k += 2) {
    const NodePath path{points[k], points[k] + btScalar(0.4) * (points[k + 1] - points[k])};
    if (!probe.enter({points[k], (path.predicted - path.now).length()}, kReach)) continue;
    const PathState met = firstInReach(probe, path, kReach);
    if (!(met.distance.distance < BT_LARGE_FLOAT) || !(probe.at(path.now).distance > 0)) continue;
    const PathState state = decidingState(probe, path, kKept, kReach, met);
    for (const Eigen::Vector3d& p : ball.positions) EXPECT_LT(heightAbove(state, toBullet(p)), 5e-4);
    btScalar nearest = BT_LARGE_FLOAT;
    for (int step = 0; step <= 100; ++step) {
      nearest = btMin(nearest, probe.at(path.now.lerp(path.predicted, btScalar(step) / 100)).distance);
    }
    if (nearest < 0) {
      EXPECT_EQ(state.where, met.where);
      ++entering;
    } else if (nearest > kKept) {
      EXPECT_LT(violation(state, path), 0.2 * kKept);
      ++passing;
    }
  }
  EXPECT_GT(passing, 50);
  EXPECT_GT(entering, 50);
}

}  // namespace
}  // namespace tetskin::test
