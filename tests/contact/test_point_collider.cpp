// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <tetskin/contact/src/rigid/surface_patches.h>
#include <tetskin/solver/src/search/point_collider.h>

#include <set>

namespace tetskin::test {

using namespace bullet_detail;
using namespace contact_detail;

namespace {

constexpr btScalar kMargin = btScalar(0.002), kSlack = btScalar(0.005);

/// Nodes that may move, and a surface bound to them.
class TouchSearchTest : public ::testing::Test {
 protected:
  TouchSearchTest() {
    for (const Eigen::Vector3d& p : cage_.nodes) nodes_.push_back({toBullet(p), toBullet(p)});
    patches_ = makeContactPatches(embed(cage_, mesh_).value(), mesh_, {});
  }

  PointCollider makeSearch() const { return PointCollider(patches_, kSlack); }
  void moveBy(const btVector3& now, const btVector3& direction) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_[n].now = toBullet(cage_.nodes[n]) + now;
      nodes_[n].predicted = nodes_[n].now + direction;
    }
  }
  PointContacts find(PointCollider& search, const btCollisionShape& shape, const btVector3& at, ShapeMemory& memory) {
    return find(search, shape, placeAt(at), memory);
  }
  PointContacts find(PointCollider& search, const btCollisionShape& shape, const btTransform& at, ShapeMemory& memory) {
    ExactProbe probe;
    probe.take(*ExactShape::exactShape(shape));
    search.begin(nodes_, kMargin, speculation_);
    return search.find(probe, {at, at}, memory);
  }
  PointContacts findAnew(const btCollisionShape& shape, const btVector3& at) {
    PointCollider search = makeSearch();
    ShapeMemory memory;
    return find(search, shape, at, memory);
  }

  /// The index of the patch that a point belongs to.
  static std::size_t patchOf(std::uint32_t point, const ContactPatches& of) {
    std::size_t k = 0;
    while (point - of.patches[k].firstPoint >= of.patches[k].numberCount()) ++k;
    return k;
  }
  btVector3 pointOf(const ContactPatch& patch, std::uint32_t p) const {
    btVector3 point(0, 0, 0);
    const std::size_t first = patch.firstWeight + p * patch.nodeCount;
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      point += patches_.weights[first + n] * nodes_[static_cast<std::size_t>(patches_.nodes[patch.firstNode + n])].now;
    }
    return point;
  }

  TetMesh cage_ = looseCage();
  TriangleMesh mesh_ = ballMesh(20, 0.35);
  ContactPatches patches_;
  std::vector<NodePath> nodes_;
  btScalar speculation_ = 0;
};

TEST_F(TouchSearchTest, FindsOfEachPatchInTouchTheDeepestPointAndAFewMore) {
  const btSphereShape shape(btScalar(0.3));
  std::size_t all = 0;
  for (const btVector3& at : {btVector3(0, btScalar(-0.64), 0), btVector3(btScalar(0.4), btScalar(0.4), btScalar(0.2)),
                              btVector3(0, btScalar(-0.66), 0)}) {
    const auto touches = findAnew(shape, at);
    std::size_t found = 0;
    for (std::size_t k = 0; k < patches_.patches.size(); ++k) {
      const ContactPatch& patch = patches_.patches[k];
      std::size_t inTouch = 0, told = 0;
      btScalar deepest = 0, deepestTold = 0;
      for (std::uint32_t p = 0; p < patch.pointCount; ++p) {
        const btScalar distance = (pointOf(patch, p) - at).length() - btScalar(0.3) - kMargin;
        inTouch += distance < 0;
        deepest = std::min(deepest, distance);
      }
      for (const PointContact& touch : touches) {
        if (patchOf(touch.point, patches_) != k) continue;
        ++told;
        deepestTold = std::min(deepestTold, touch.distance);
        EXPECT_GE(touch.point, patch.firstPoint);
        EXPECT_LT(touch.point, patch.firstPoint + patch.pointCount);
        EXPECT_LT((touch.position - pointOf(patch, touch.point - patch.firstPoint)).length(), 1e-5);
      }
      EXPECT_GE(told, std::min(inTouch, kMinTouches));
      EXPECT_LE(told, std::min(inTouch, kMaxTouches));
      EXPECT_NEAR(deepestTold, deepest, 1e-5);
      found += told;
    }
    EXPECT_EQ(found, touches.size());
    all += found;
    for (const PointContact& touch : touches) {
      EXPECT_LT(touch.distance, 0);
      EXPECT_NEAR((touch.position - at).length() - btScalar(0.3) - kMargin, touch.distance, 1e-5);
      EXPECT_NEAR((touch.position - at).normalized().dot(touch.normal), 1, 1e-4);
    }
  }
  EXPECT_GT(all, 0u);
}

TEST_F(TouchSearchTest, MeetsWhatIsPassedInOneStep) {
  const btBoxShape plate(btVector3(1, btScalar(0.005), 1));
  moveBy(btVector3(0, 1, 0), btVector3(0, -2, 0));
  const auto touches = findAnew(plate, btVector3(0, 0, 0));
  ASSERT_FALSE(touches.empty());
  for (const PointContact& touch : touches) {
    EXPECT_NEAR(touch.normal.y(), 1, 1e-5);  // on the side from which the body comes
    EXPECT_NEAR(touch.distance, touch.position.y() - btScalar(0.005) - kMargin, 1e-3);
  }
}

TEST_F(TouchSearchTest, StopsPointsByBothSidesOfAnEdge) {
  const btBoxShape box(btVector3(1, 1, 1));
  const btTransform edge =
      placeAt(btVector3(0, -btSqrt(btScalar(2)), 0), btQuaternion(btVector3(0, 0, 1), SIMD_PI / 4));
  moveBy(btVector3(0, btScalar(0.4), 0), btVector3(0, btScalar(-0.15), 0));
  PointCollider search = makeSearch();
  ShapeMemory memory;
  std::size_t left = 0, right = 0;
  for (const PointContact& touch : find(search, box, edge, memory)) {
    left += touch.normal.x() < btScalar(-0.5);
    right += touch.normal.x() > btScalar(0.5);
  }
  EXPECT_GT(left, 0u);
  EXPECT_GT(right, 0u);
}

TEST_F(TouchSearchTest, GoesOnWithThePointsOfTheStepBefore) {
  const btBoxShape ground(btVector3(2, 1, 2));
  PointCollider search = makeSearch();
  ShapeMemory memory;
  const auto pointsAfter = [&](btScalar tilt) {
    moveBy(btVector3(0, btScalar(0.33), 0), btVector3(0, btScalar(-0.001), 0));
    for (NodePath& node : nodes_) {
      node.now.setY(node.now.y() + tilt * node.now.x());
      node.predicted.setY(node.predicted.y() + tilt * node.now.x());
    }
    std::set<std::uint32_t> points;
    for (const PointContact& touch : find(search, ground, placeAt(btVector3(0, -1, 0)), memory)) {
      points.insert(touch.point);
    }
    return points;
  };
  const auto before = pointsAfter(0);
  EXPECT_GT(before.size(), kMinTouches);
  EXPECT_EQ(pointsAfter(btScalar(1e-4)), before);
}

TEST_F(TouchSearchTest, LeavesAloneWhatGoesAway) {
  const btBoxShape ground(btVector3(1, 1, 1));
  moveBy(btVector3(0, btScalar(0.3525), 0), btVector3(0, btScalar(0.01), 0));
  EXPECT_TRUE(findAnew(ground, btVector3(0, -1, 0)).empty());
  moveBy(btVector3(0, btScalar(0.3525), 0), btVector3(0, btScalar(-0.01), 0));
  EXPECT_FALSE(findAnew(ground, btVector3(0, -1, 0)).empty());
}

TEST_F(TouchSearchTest, RemembersNothingThatIsNotSo) {
  const btSphereShape shape(btScalar(0.3));
  PointCollider search = makeSearch();
  ShapeMemory memory;
  std::mt19937 random(5);
  btVector3 now(0, btScalar(0.68), 0);
  int touched = 0;
  for (int step = 0; step < 400; ++step) {
    const auto part = [&] { return btScalar(0.004) * (btScalar(random()) / btScalar(0x80000000u) - 1); };
    const btScalar x = part(), y = part(), z = part();
    const btVector3 direction(x, y - btScalar(0.3) * (now.y() - btScalar(0.651)), z);
    moveBy(now, direction);
    speculation_ = btScalar(0.001) * static_cast<btScalar>(step % 4);
    const auto kept = find(search, shape, btVector3(0, 0, 0), memory), anew = findAnew(shape, btVector3(0, 0, 0));
    // The choice of points within a patch depends on those of the previous step.
    std::set<std::uint32_t> keptPatches, newPatches;
    for (const PointContact& touch : kept) keptPatches.insert(patchOf(touch.point, patches_));
    for (const PointContact& touch : anew) newPatches.insert(patchOf(touch.point, patches_));
    ASSERT_EQ(keptPatches, newPatches) << step;
    touched += !kept.empty();
    now += direction;
    if (step % 50 == 49) now.setY(now.y() + btScalar(0.03));
  }
  EXPECT_GT(touched, 50);
  EXPECT_LT(touched, 390);
}

}  // namespace
}  // namespace tetskin::test
