// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact of a body's nodes, which are points of the same search as those of surfaces.
#include "deformable_test.h"
#include "support/points_within.h"

#include <tetskin/solver/src/search/body_contacts.h>

#include <set>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr btScalar kMargin = btScalar(0.05);
constexpr int kNodes = 2000;

/// A body of scattered moving nodes, and an object that also moves.
class NodeContacts : public testing::Test {
 protected:
  NodeContacts() : body_(worldInfo_, pointsWithin(2, kNodes)) {
    worldInfo_.m_sparsesdf.Initialize();
    body_.getCollisionShape()->setMargin(kMargin);
    body_.m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
    body_.m_sst.sdt = 1;
    const std::vector<btVector3> motions = pointsWithin(btScalar(0.1), kNodes);
    for (int n = 0; n < kNodes; ++n) {
      body_.m_nodes[n].m_im = 1;
      body_.m_nodes[n].m_v = motions[static_cast<std::size_t>(n)];
    }
    contacts_ = makeNodeContacts(body_, sizeOfNodes(body_));
    object_.setCollisionFlags(0);
    object_.setWorldTransform(btTransform(btQuaternion(btVector3(1, 2, 3), btScalar(0.7)), {btScalar(0.3), 0, 0}));
    btTransform predicted = object_.getWorldTransform();
    predicted.getOrigin() += btVector3(0, btScalar(0.05), 0);
    object_.setInterpolationWorldTransform(predicted);
  }

  /// Numbers of the nodes in contact.
  std::set<int> find(btCollisionShape& shape) {
    object_.setCollisionShape(&shape);
    BodyChannel::of(body_).pointContacts().clear();
    contacts_->collide({nullptr, &shape, &object_, object_.getWorldTransform(), -1, -1});
    std::set<int> nodes;
    for (const PointContact& contact : BodyChannel::of(body_).pointContacts()) {
      EXPECT_EQ(contact.at.count, 1U);
      EXPECT_EQ((contact.position - body_.m_nodes[contact.at.nodes[0]].m_x).length() < btScalar(1e-5), true);
      nodes.insert(contact.at.nodes[0]);
    }
    EXPECT_EQ(nodes.size(), BodyChannel::of(body_).pointContacts().size());
    return nodes;
  }
  /// A position on a node's path, in the object's space.
  btVector3 onPath(int n, btScalar fraction) const {
    const btSoftBody::Node& node = body_.m_nodes[n];
    const btVector3 begin = object_.getWorldTransform().invXform(node.m_x);
    return begin.lerp(object_.getInterpolationWorldTransform().invXform(node.m_x + node.m_v), fraction);
  }
  /// Every node that begins or ends nearer than the margin is found, and none that stays farther on all its path.
  template <class Distance>
  void expectFound(btCollisionShape& shape, const Distance& distance) {
    constexpr int kParts = 200;
    constexpr btScalar kTolerance = btScalar(0.002);
    const std::set<int> found = find(shape);
    int within = 0;
    for (int n = 0; n < kNodes; ++n) {
      btScalar least = BT_LARGE_FLOAT;
      for (int k = 0; k <= kParts; ++k) least = std::min(least, distance(onPath(n, btScalar(k) / kParts)));
      const bool ends = std::min(distance(onPath(n, 0)), distance(onPath(n, 1))) < kMargin - kTolerance;
      if (ends || least > kMargin + kTolerance) {
        EXPECT_EQ(found.count(n), ends ? 1U : 0U) << shape.getName() << " " << n;
      }
      within += ends;
    }
    EXPECT_GT(within, 20) << shape.getName();
  }

  btSoftBodyWorldInfo worldInfo_;
  BodyWithTrees body_;
  std::shared_ptr<BodyContacts> contacts_;
  btCollisionObject object_;
};

TEST_F(NodeContacts, AreTheNodesWhosePathsComeWithinTheMarginOfAnExactShape) {
  btBoxShape box(btVector3(1, btScalar(0.4), btScalar(0.7)));
  btSphereShape sphere(1);
  btCapsuleShape capsule(btScalar(0.5), 1);
  btCylinderShape cylinder(btVector3(btScalar(0.6), 1, btScalar(0.6)));
  for (btCollisionShape* shape : std::initializer_list<btCollisionShape*>{&box, &sphere, &capsule, &cylinder}) {
    const auto exact = ExactShape::exactShape(*shape);
    expectFound(*shape, [&](const btVector3& at) { return exact->distance(at).distance; });
  }
}

/// As drawn, that is, without its margin.
TEST_F(NodeContacts, MeetAHullAtItsFaces) {
  btConvexHullShape cube;
  for (int c = 0; c < 8; ++c) cube.addPoint(btVector3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1));
  btBoxShape box(btVector3(1, 1, 1));
  const auto exact = ExactShape::exactShape(box);
  expectFound(cube, [&](const btVector3& at) { return exact->distance(at).distance; });
}

TEST_F(NodeContacts, MeetAMeshOnItsOuterSide) {
  btTriangleMesh square;
  const btVector3 a(-2, 0, -2), b(-2, 0, 2), c(2, 0, 2), d(2, 0, -2);
  square.addTriangle(a, b, c);
  square.addTriangle(a, c, d);
  btBvhTriangleMeshShape mesh(&square, true);
  object_.setInterpolationWorldTransform(object_.getWorldTransform());
  const std::set<int> found = find(mesh);
  int above = 0;
  for (int n = 0; n < kNodes; ++n) {
    const btVector3 begin = onPath(n, 0), end = onPath(n, 1);
    if (std::max({btFabs(begin.x()), btFabs(begin.z()), btFabs(end.x()), btFabs(end.z())}) > btScalar(1.9)) continue;
    const bool crosses = begin.y() > 0 && end.y() < kMargin;
    EXPECT_TRUE(!crosses || found.count(n) == 1) << n;
    above += crosses;
  }
  EXPECT_GT(above, 20);
  for (const PointContact& contact : BodyChannel::of(body_).pointContacts()) {
    const btVector3 begin = onPath(contact.at.nodes[0], 0).absolute();
    if (std::max(begin.x(), begin.z()) > btScalar(1.8)) continue;  // at the rim, it may be beside the mesh
    EXPECT_NEAR((contact.normal - object_.getWorldTransform().getBasis().getColumn(1)).length(), 0, 1e-5);
  }
}

TEST_F(NodeContacts, PassOverNodesThatAreAnchoredOrPinned) {
  btSphereShape sphere(1);
  std::set<int> expected = find(sphere);
  const int anchored = *expected.begin(), pinned = *std::next(expected.begin());
  body_.m_nodes[anchored].m_battach = -1;  // one bit, signed
  body_.m_nodes[pinned].m_im = 0;
  expected.erase(anchored);
  expected.erase(pinned);
  EXPECT_EQ(find(sphere), expected);
}

TEST_F(NodeContacts, AreNoneWhereTheApplicationWantsNoContactAtNodes) {
  btSphereShape sphere(1);
  body_.m_cfg.collisions = btSoftBody::fCollision::SDF_RD;
  EXPECT_TRUE(find(sphere).empty());
}

/// A point that is clear at one margin need not be so at another one.
TEST_F(NodeContacts, FollowTheMarginThatTheApplicationSets) {
  btSphereShape sphere(1);
  const std::size_t before = find(sphere).size();
  body_.getCollisionShape()->setMargin(4 * kMargin);
  const std::set<int> wider = find(sphere);
  EXPECT_GT(wider.size(), before);
  contacts_ = makeNodeContacts(body_, sizeOfNodes(body_));
  EXPECT_EQ(find(sphere), wider);
}

}  // namespace
}  // namespace tetskin::test
