// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "deformable_test.h"
#include "support/points_within.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <gtest/gtest.h>
#include <tetskin/bullet/src/base/exact_distance.h>
#include <tetskin/bullet/src/search/node_contacts.h>

#include <algorithm>
#include <set>

namespace tetskin {

using namespace bullet_detail;

namespace {

using test::pointsWithin;

constexpr btScalar kMargin = btScalar(0.05);

/// A body of scattered nodes that move, beside a shape.
class NodeContacts : public testing::Test {
 protected:
  NodeContacts() : body_(&worldInfo_) {
    worldInfo_.m_sparsesdf.Initialize();
    body_.appendMaterial();
    body_.getCollisionShape()->setMargin(kMargin);
    body_.m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
    for (const btVector3& point : pointsWithin(2, 2000)) body_.appendNode(point, 1);
    const std::vector<btVector3> motions = pointsWithin(btScalar(0.1), 2000);
    std::vector<NodeTravel>& travels = paths_.begin(motions.size());
    for (int n = 0; n < body_.m_nodes.size(); ++n) {
      btSoftBody::Node& node = body_.m_nodes[n];
      node.m_q = node.m_x + motions[static_cast<std::size_t>(n)];
      node.m_effectiveMass_inv.setIdentity();
      travels[static_cast<std::size_t>(n)] = {node.m_x, node.m_q};
    }
    object_.setWorldTransform(btTransform(btQuaternion(btVector3(1, 2, 3), btScalar(0.7)), {btScalar(0.3), 0, 0}));
    btTransform predicted = object_.getWorldTransform();
    predicted.getOrigin() += btVector3(0, btScalar(0.05), 0);
    object_.setInterpolationWorldTransform(predicted);
  }

  /// Numbers of the nodes in contact.
  std::set<long> find(btCollisionShape& shape, bool solved) {
    object_.setCollisionShape(&shape);
    body_.m_nodeRigidContacts.clear();
    const btCollisionObjectWrapper wrapper(nullptr, &shape, &object_, object_.getWorldTransform(), -1, -1);
    findNodeContacts(body_, wrapper, paths_, solved);
    return nodesInContact();
  }
  std::set<long> findByBullet(btCollisionShape& shape) {
    object_.setCollisionShape(&shape);
    body_.m_nodeRigidContacts.clear();
    const btCollisionObjectWrapper wrapper(nullptr, &shape, &object_, object_.getWorldTransform(), -1, -1);
    btSoftColliders::CollideSDF_RD bullets;
    bullets.psb = &body_;
    bullets.m_colObj1Wrap = &wrapper;
    bullets.m_rigidBody = nullptr;
    bullets.dynmargin = bullets.stamargin = kMargin;
    for (int n = 0; n < body_.m_nodes.size(); ++n) bullets.DoNode(body_.m_nodes[n]);
    return nodesInContact();
  }
  std::set<long> nodesInContact() {
    std::set<long> nodes;
    for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k) {
      nodes.insert(body_.m_nodeRigidContacts[k].m_node - &body_.m_nodes[0]);
    }
    EXPECT_EQ(nodes.size(), static_cast<std::size_t>(body_.m_nodeRigidContacts.size()));
    return nodes;
  }

  btSoftBodyWorldInfo worldInfo_;
  btSoftBody body_;
  NodePaths paths_;
  btCollisionObject object_;
};

btConvexHullShape pyramid() {
  btConvexHullShape hull;
  for (const btScalar x : {-1, 1}) {
    for (const btScalar z : {-1, 1}) hull.addPoint(btVector3(x, 0, z));
  }
  hull.addPoint(btVector3(0, btScalar(1.5), 0));
  return hull;
}

TEST_F(NodeContacts, AreTheNodesWhosePathsComeWithinTheMarginOfAnExactShape) {
  btBoxShape box(btVector3(1, btScalar(0.4), btScalar(0.7)));
  btSphereShape sphere(1);
  btCapsuleShape capsule(btScalar(0.5), 1);
  btCylinderShape cylinder(btVector3(btScalar(0.6), 1, btScalar(0.6)));
  int beside = 0, asBefore = 0;
  for (btCollisionShape* shape : std::initializer_list<btCollisionShape*>{&box, &sphere, &capsule, &cylinder}) {
    const auto exact = ExactShape::exactShape(*shape);
    std::set<long> through;
    const std::set<long> found = find(*shape, true);
    for (int n = 0; n < body_.m_nodes.size(); ++n) {
      const btVector3 begin = object_.getWorldTransform().invXform(body_.m_nodes[n].m_x);
      const btVector3 end = object_.getInterpolationWorldTransform().invXform(body_.m_nodes[n].m_q);
      constexpr int kParts = 500;
      btScalar least = BT_LARGE_FLOAT;
      for (int k = 0; k <= kParts; ++k) {
        least = std::min(least, exact->distance(begin.lerp(end, btScalar(k) / kParts)).distance);
      }
      const bool ends = std::min(exact->distance(begin).distance, exact->distance(end).distance) < kMargin;
      if (std::abs(least - kMargin) > btScalar(0.002)) {
        EXPECT_EQ(found.count(n), least < kMargin ? 1U : 0U) << shape->getName() << " " << n;
        if (least < kMargin && !ends) through.insert(n);
      }
    }
    EXPECT_GT(found.size(), 20U) << shape->getName();
    for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k) {
      const auto& contact = body_.m_nodeRigidContacts[k];
      const btVector3 begin = object_.getWorldTransform().invXform(contact.m_node->m_x);
      const btVector3 end = object_.getInterpolationWorldTransform().invXform(contact.m_node->m_q);
      const btVector3 normal = object_.getWorldTransform().getBasis().transpose() * contact.m_cti.m_normal;
      if (through.count(contact.m_node - &body_.m_nodes[0]) > 0) {
        // Along its normal, the contact is as far away as the path is from it.
        EXPECT_GT(contact.m_cti.m_offset, 0);
        EXPECT_LT(contact.m_cti.m_offset + normal.dot(end - begin), btScalar(1e-3));
        continue;
      }
      // Beside the shape, the side on which the path ends decides, unless it is the other one.
      ShapeDistance at = exact->distance(end);
      const ShapeDistance before = exact->distance(begin);
      if (std::min(before.distance, at.distance) > kMargin - btScalar(0.002)) continue;
      if (btFabs(at.distance - kMargin) < btScalar(1e-5) || btFabs(at.normal.dot(before.normal)) < 1e-4) continue;
      if (at.distance > 0 && at.distance < kMargin && at.normal.dot(before.normal) > 0) {
        ++beside;
        at.distance += at.normal.dot(begin - end);
      } else {
        ++asBefore;
        at = before;
      }
      EXPECT_NEAR(contact.m_cti.m_offset, at.distance - kMargin, 1e-6);
      EXPECT_NEAR((normal - at.normal).length(), 0, 1e-6);
    }
  }
  EXPECT_GT(beside, 20);
  EXPECT_GT(asBefore, 20);
}

/// Of a mesh, Bullet passes each triangle as a prism 0.12 thick, which is measured exactly. Its sides are inner edges
/// of the mesh: a node inside belongs to the upper or the lower side.
TEST_F(NodeContacts, OfATriangleOfAMeshAreOnItsUpperOrLowerSide) {
  constexpr btScalar kHalf = btScalar(0.06);
  const btVector3 corners[3] = {btVector3(-2, 0, -2), btVector3(-2, 0, 2), btVector3(2, 0, 0)};
  btConvexHullShape prism;
  for (const btScalar side : {kHalf, -kHalf}) {
    for (const btVector3& corner : corners) prism.addPoint(corner + btVector3(0, side, 0));
  }
  object_.setCollisionShape(&prism);
  object_.setInterpolationWorldTransform(object_.getWorldTransform());
  const btCollisionObjectWrapper triangle(nullptr, &prism, &object_, object_.getWorldTransform(), 0, 3);
  findNodeContacts(body_, triangle, paths_, true);
  const auto isOver = [&](const btVector3& point) {
    for (int c = 0; c < 3; ++c) {
      if (!((corners[(c + 1) % 3] - corners[c]).cross(point - corners[c]).y() > 0)) return false;
    }
    return true;
  };
  const auto local = [&](const btVector3& point) { return object_.getWorldTransform().invXform(point); };
  int expected = 0, above = 0, beside = 0;
  for (int n = 0; n < body_.m_nodes.size(); ++n) {
    const btVector3 then = local(body_.m_nodes[n].m_q);
    expected += isOver(then) && btFabs(then.y()) < kHalf + kMargin;
  }
  for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k) {
    const auto& contact = body_.m_nodeRigidContacts[k];
    const btVector3 then = local(contact.m_node->m_q);
    const btVector3 normal = object_.getWorldTransform().getBasis().transpose() * contact.m_cti.m_normal;
    const btScalar end = contact.m_cti.m_offset + contact.m_cti.m_normal.dot(contact.m_node->m_q - contact.m_node->m_x);
    if (!isOver(then) || btFabs(then.y()) > kHalf + kMargin) {
      // It is too near where its path begins, or ends so beside the triangle.
      ++beside;
      EXPECT_TRUE(contact.m_cti.m_offset < 0 || end < 0);
      continue;
    }
    ++above;
    if (btFabs(then.y()) < kHalf) continue;
    EXPECT_NEAR(btFabs(normal.y()), 1, 1e-5);
    EXPECT_NEAR(end, btFabs(then.y()) - kHalf - kMargin, 1e-5);
  }
  EXPECT_EQ(above, expected);
  EXPECT_GT(above, 20);
  EXPECT_GT(beside, 0);
}

/// Whatever is fast may be on the other side of a thin shape when the step ends.
TEST_F(NodeContacts, IncludeNodesWhosePathsLeadThroughAThinShape) {
  btBoxShape thin(btVector3(1, btScalar(0.01), 1));
  body_.m_nodes[0].m_x = object_.getWorldTransform() * btVector3(0, btScalar(0.5), 0);
  body_.m_nodes[0].m_q = object_.getInterpolationWorldTransform() * btVector3(btScalar(0.1), btScalar(-0.5), 0);
  std::vector<NodeTravel>& travels = paths_.begin(static_cast<std::size_t>(body_.m_nodes.size()));
  for (int n = 0; n < body_.m_nodes.size(); ++n) {
    travels[static_cast<std::size_t>(n)] = {body_.m_nodes[n].m_x, body_.m_nodes[n].m_q};
  }
  ASSERT_EQ(find(thin, true).count(0), 1U);
  for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k) {
    const auto& contact = body_.m_nodeRigidContacts[k];
    if (contact.m_node != &body_.m_nodes[0]) continue;
    EXPECT_NEAR(contact.m_cti.m_offset, btScalar(0.49) - kMargin, 1e-5);
    EXPECT_NEAR((contact.m_cti.m_normal - object_.getWorldTransform().getBasis().getColumn(1)).length(), 0, 1e-5);
  }
}

/// Bullet passes two triangles of a plane, and keeps those of the first step.
TEST_F(NodeContacts, OfATriangleOfAPlaneAreThoseOfThePlaneOnce) {
  btStaticPlaneShape plane(btVector3(0, 1, 0), btScalar(0.2));
  const std::set<long> expected = find(plane, true);
  ASSERT_GT(expected.size(), 100u);
  btConvexHullShape triangle;
  for (const btVector3& corner : {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 0, 1)})
    triangle.addPoint(corner);
  body_.m_nodeRigidContacts.clear();
  const btCollisionObjectWrapper wrapper(nullptr, &triangle, &object_, object_.getWorldTransform(), 0, 1);
  for (int k = 0; k < 2; ++k) findNodeContacts(body_, wrapper, paths_, true);
  EXPECT_EQ(nodesInContact(), expected);
}

TEST_F(NodeContacts, OfOtherShapesAreBullets) {
  btConvexHullShape hull = pyramid();
  const std::set<long> expected = findByBullet(hull);
  EXPECT_GT(expected.size(), 20U);
  // Bullet's are those that will be within the margin; here, those that are so already count, too.
  const std::set<long> found = find(hull, true);
  EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
  for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k) {
    const auto& contact = body_.m_nodeRigidContacts[k];
    if (expected.count(contact.m_node - &body_.m_nodes[0]) > 0) continue;
    EXPECT_LT(contact.m_cti.m_offset, 0);
  }
}

/// Bodies that Bullet's forces act on get Bullet's contacts, with Bullet's distances, whatever the shape.
TEST_F(NodeContacts, OfBodiesThatAreNotSolvedHereAreBulletsToTheBit) {
  btBoxShape box(btVector3(1, btScalar(0.4), btScalar(0.7)));
  const std::set<long> expected = findByBullet(box);
  std::vector<btScalar> offsets;
  for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k)
    offsets.push_back(body_.m_nodeRigidContacts[k].m_cti.m_offset);
  ASSERT_EQ(find(box, false), expected);
  for (int k = 0; k < body_.m_nodeRigidContacts.size(); ++k) {
    EXPECT_EQ(body_.m_nodeRigidContacts[k].m_cti.m_offset, offsets[static_cast<std::size_t>(k)]);
  }
}

/// Nodes are listed by leaves of many, and Bullet's test of a node is slow: only those near the shape are tested.
TEST_F(NodeContacts, OfBodiesThatAreNotSolvedHereAreSearchedForNearTheShapeOnly) {
  btSphereShape sphere(btScalar(0.2));
  int near = 0;
  for (int n = 0; n < body_.m_nodes.size(); ++n) {
    const btVector3 path = body_.m_nodes[n].m_x - object_.getWorldTransform().getOrigin();
    near += path.length() < btScalar(0.2 * 1.8 + 0.1 * 1.8 + 0.05) + 2 * kMargin;
  }
  worldInfo_.m_sparsesdf.nqueries = 0;
  const std::size_t contacts = find(sphere, false).size();
  EXPECT_GT(contacts, 0U);
  EXPECT_LE(worldInfo_.m_sparsesdf.nqueries, near + static_cast<int>(contacts));
}

TEST_F(NodeContacts, PassOverNodesThatAreAnchoredOrHeldAgainstWhatIsStatic) {
  btSphereShape sphere(1);
  const std::set<long> all = find(sphere, true);
  const int anchored = static_cast<int>(*all.begin()), held = static_cast<int>(*std::next(all.begin()));
  body_.m_nodes[anchored].m_battach = -1;  // one bit, signed
  body_.m_nodes[held].m_im = 0;
  std::set<long> expected = all;
  expected.erase(anchored);
  expected.erase(held);
  EXPECT_EQ(find(sphere, true), expected);
}

/// The paths of the nodes are searched by boxes.
TEST_F(NodeContacts, NodePathsListAllNodesNearABox) {
  for (const btVector3& centre : pointsWithin(2, 50)) {
    BvhBox<btScalar> box;
    box.extend(centre);
    box = box.grownBy(btScalar(0.3));
    const std::vector<int> near = paths_.near(box);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    for (int n = 0; n < body_.m_nodes.size(); ++n) {
      BvhBox<btScalar> path;
      path.extend(body_.m_nodes[n].m_x);
      path.extend(body_.m_nodes[n].m_q);
      if (!path.collides(box)) continue;
      EXPECT_TRUE(std::binary_search(near.begin(), near.end(), n)) << n;
    }
    EXPECT_LT(near.size(), 500U);
  }
}

}  // namespace
}  // namespace tetskin
