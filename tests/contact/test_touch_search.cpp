// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <tetskin/contact/src/rigid/touch_search.h>

#include <random>
#include <set>

namespace tetskin::test {
namespace {

constexpr btScalar kMargin = btScalar(0.002), kSlack = btScalar(0.005);

/// Nodes that may move, and the surface on them.
class TouchSearchTest : public ::testing::Test {
 protected:
  TouchSearchTest() {
    for (const Eigen::Vector3d& p : cage_.nodes) nodes_.push_back({toBullet(p), toBullet(p)});
    patches_ = makeContactPatches(embed(cage_, mesh_).value(), mesh_, 0.0);
  }

  TouchSearch makeSearch() const { return TouchSearch(patches_, kMargin, btScalar(0.1), kSlack); }
  void moveBy(const btVector3& now, const btVector3& way) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_[n].now = toBullet(cage_.nodes[n]) + now;
      nodes_[n].predicted = nodes_[n].now + way;
    }
  }
  std::vector<NodeTouch> find(TouchSearch& search, const btCollisionShape& shape, const btVector3& at,
                              ShapeMemory& memory) {
    return find(search, shape, placeAt(at), memory);
  }
  std::vector<NodeTouch> find(TouchSearch& search, const btCollisionShape& shape, const btTransform& at,
                              ShapeMemory& memory) {
    ExactProbe probe;
    probe.take(*ExactShape::of(shape));
    search.begin(nodes_);
    return search.find(probe, {at, at}, memory);
  }
  std::vector<NodeTouch> findAnew(const btCollisionShape& shape, const btVector3& at) {
    TouchSearch search = makeSearch();
    ShapeMemory memory;
    return find(search, shape, at, memory);
  }

  TetMesh cage_ = looseCage();
  TriangleMesh mesh_ = ballMesh(20, 0.35);
  ContactPatches patches_;
  std::vector<NodePath> nodes_;
};

TEST_F(TouchSearchTest, FindsTheNodesOfAllPointsInTouch) {
  const btSphereShape shape(btScalar(0.3));
  for (const btVector3& at : {btVector3(0, btScalar(-0.64), 0), btVector3(btScalar(0.4), btScalar(0.4), btScalar(0.2)),
                              btVector3(0, btScalar(-0.66), 0)}) {
    std::set<int> expected;
    for (const ContactPatch& patch : patches_.patches) {
      for (std::uint32_t p = 0; p < patch.pointCount; ++p) {
        btVector3 point(0, 0, 0);
        const std::size_t first = patch.firstWeight + p * patch.nodeCount;
        for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
          point +=
              patches_.weights[first + n] * nodes_[static_cast<std::size_t>(patches_.nodes[patch.firstNode + n])].now;
        }
        if ((point - at).length() - btScalar(0.3) >= kMargin) continue;
        for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
          if (patches_.weights[first + n] >= btScalar(0.1)) expected.insert(patches_.nodes[patch.firstNode + n]);
        }
      }
    }
    std::set<int> found;
    for (const NodeTouch& touch : findAnew(shape, at)) {
      EXPECT_TRUE(found.insert(touch.node).second);
      EXPECT_LT(touch.distance, 0);
      EXPECT_NEAR((touch.position - at).length() - btScalar(0.3) - kMargin, touch.distance, 1e-5);
      EXPECT_NEAR((touch.position - at).normalized().dot(touch.normal), 1, 1e-4);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST_F(TouchSearchTest, MeetsWhatIsPassedInOneStep) {
  const btBoxShape plate(btVector3(1, btScalar(0.005), 1));
  moveBy(btVector3(0, 1, 0), btVector3(0, -2, 0));
  const auto touches = findAnew(plate, btVector3(0, 0, 0));
  ASSERT_FALSE(touches.empty());
  for (const NodeTouch& touch : touches) {
    EXPECT_NEAR(touch.normal.y(), 1, 1e-5);  // on the side where it comes from
    EXPECT_NEAR(touch.distance, touch.position.y() - btScalar(0.005) - kMargin, 1e-3);
  }
}

TEST_F(TouchSearchTest, StopsANodeByBothSidesOfAnEdge) {
  const btBoxShape box(btVector3(1, 1, 1));
  const btTransform edge =
      placeAt(btVector3(0, -btSqrt(btScalar(2)), 0), btQuaternion(btVector3(0, 0, 1), SIMD_PI / 4));
  moveBy(btVector3(0, btScalar(0.4), 0), btVector3(0, btScalar(-0.15), 0));
  TouchSearch search = makeSearch();
  ShapeMemory memory;
  std::multiset<int> found;
  const auto touches = find(search, box, edge, memory);
  for (const NodeTouch& touch : touches) {
    found.insert(touch.node);
    for (const NodeTouch& other : touches) {
      if (&other == &touch || other.node != touch.node) continue;
      EXPECT_LT(touch.normal.dot(other.normal), 0.75);
    }
  }
  std::size_t twice = 0;
  for (const int node : found) twice += found.count(node) == 2;
  EXPECT_GT(twice, 0u);
}

/// The deepest of a node's points may be one that has come from far: another one that is nearer must not go as far.
TEST_F(TouchSearchTest, LetsANodeGoAsFarAsAllItsPointsMay) {
  const btBoxShape ground(btVector3(2, 1, 2));
  // Tilts while it falls: what is lowest is not what goes deepest.
  for (NodePath& node : nodes_) node.predicted.setY(node.now.y() - btScalar(0.2) - btScalar(0.5) * node.now.x());
  const auto touches = findAnew(ground, btVector3(0, btScalar(-1.36), 0));
  std::size_t held = 0;
  for (const NodeTouch& touch : touches) {
    btScalar least = touch.distance;
    for (const ContactPatch& patch : patches_.patches) {
      for (std::uint32_t p = 0; p < patch.pointCount; ++p) {
        const std::size_t first = patch.firstWeight + p * patch.nodeCount;
        btScalar now = 0, predicted = 0, share = 0;
        for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
          const int node = patches_.nodes[patch.firstNode + n];
          const NodePath& path = nodes_[static_cast<std::size_t>(node)];
          now += patches_.weights[first + n] * path.now.y();
          predicted += patches_.weights[first + n] * path.predicted.y();
          if (node == touch.node) share = patches_.weights[first + n];
        }
        const btScalar above = btScalar(-0.36) + kMargin;
        if (share >= btScalar(0.1) && predicted < above) least = std::min(least, now - above);
      }
    }
    EXPECT_NEAR(touch.room, least, 1e-4);
    held += touch.room < touch.distance - btScalar(0.01);
  }
  EXPECT_GT(held, 0u);
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
  TouchSearch search = makeSearch();
  ShapeMemory memory;
  std::mt19937 random(5);
  btVector3 now(0, btScalar(0.68), 0);
  int touched = 0;
  for (int step = 0; step < 400; ++step) {
    const auto part = [&] { return btScalar(0.004) * (btScalar(random()) / btScalar(0x80000000u) - 1); };
    const btScalar x = part(), y = part(), z = part();
    const btVector3 way(x, y - btScalar(0.3) * (now.y() - btScalar(0.651)), z);
    moveBy(now, way);
    const auto kept = find(search, shape, btVector3(0, 0, 0), memory), anew = findAnew(shape, btVector3(0, 0, 0));
    ASSERT_EQ(kept.size(), anew.size()) << step;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      EXPECT_EQ(kept[k].node, anew[k].node);
      EXPECT_EQ(kept[k].point, anew[k].point);
    }
    touched += !kept.empty();
    now += way;
    if (step % 50 == 49) now.setY(now.y() + btScalar(0.03));
  }
  EXPECT_GT(touched, 50);
  EXPECT_LT(touched, 390);
}

}  // namespace
}  // namespace tetskin::test
