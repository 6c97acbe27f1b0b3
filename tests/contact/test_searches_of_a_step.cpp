// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body's nodes are read once for all objects that it touches in a step, and for each of them outside of steps.
#include "contact_test.h"

#include <tetskin/solver/src/base/body_channel.h>

namespace tetskin::test {
namespace {

constexpr int kObstacles = 20;
constexpr btScalar kRadius = btScalar(0.35);
const btVector3 kCentre(0, 3, 0);

/// A ball that moves and grows, and boxes all around it.
struct SurroundedBall {
  /// only  number of the box that is there; below 0: all are
  explicit SurroundedBall(int only) {
    for (int k = 0; k < kObstacles; ++k) {
      // Spread over the sphere by the golden angle.
      const double y = 1.0 - (2.0 * k + 1.0) / kObstacles, angle = 2.39996322972865332 * k, r = std::sqrt(1.0 - y * y);
      const btVector3 away(btScalar(r * std::cos(angle)), btScalar(y), btScalar(r * std::sin(angle)));
      if (only >= 0 && only != k) continue;
      obstacles.push_back(std::make_unique<Obstacle>(
          world, std::make_unique<btBoxShape>(btVector3(btScalar(0.06), btScalar(0.06), btScalar(0.06))),
          placeAt(kCentre + (kRadius + btScalar(0.05)) * away)));
    }
    for (int n = 0; n < ball.body->body().m_nodes.size(); ++n) {
      btSoftBody::Node& node = ball.body->body().m_nodes[n];
      node.m_v = btVector3(btScalar(0.5), btScalar(-0.3), 0) + btScalar(0.5) * (node.m_x - kCentre);
    }
  }
  void step() { world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240); }
  std::vector<SurfaceContactPoint> contactsWith(std::size_t k) const {
    std::vector<SurfaceContactPoint> found;
    for (const SurfaceContactPoint& at : ball.contact->contacts()) {
      if (at.object == &obstacles[k]->body()) found.push_back(at);
    }
    return found;
  }

  TetskinWorld world;
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  TouchingBody ball{world, ballMesh(24, static_cast<double>(kRadius)), kCentre};
};

TEST(SearchesOfAStep, FindWithManyObjectsWhatTheyFindWithEachAlone) {
  SurroundedBall all(-1);
  all.step();
  int met = 0;
  for (int k = 0; k < kObstacles; ++k) {
    SurroundedBall one(k);
    one.step();
    const auto wanted = one.contactsWith(0), found = all.contactsWith(static_cast<std::size_t>(k));
    ASSERT_EQ(found.size(), wanted.size()) << k;
    for (std::size_t c = 0; c < found.size(); ++c) {
      EXPECT_EQ(found[c].point, wanted[c].point);
      EXPECT_EQ(found[c].normal, wanted[c].normal);
      EXPECT_EQ(found[c].distance, wanted[c].distance);
    }
    met += wanted.empty() ? 0 : 1;
  }
  EXPECT_EQ(met, kObstacles);
}

/// The boxes are met again in the next step, when the nodes have moved.
TEST(SearchesOfAStep, FindContactsWhereTheNodesAreInThatStep) {
  SurroundedBall at(-1);
  for (int k = 0; k < 5; ++k) {
    const std::vector<Eigen::Vector3d> surface = at.ball.surface();
    at.step();
    ASSERT_FALSE(at.ball.contact->contacts().empty());
    std::size_t vertices = 0;
    for (const SurfaceContactPoint& contact : at.ball.contact->contacts()) {
      double nearest = HUGE_VAL;
      for (const Eigen::Vector3d& p : surface) nearest = std::min(nearest, (p - toEigen(contact.point)).norm());
      vertices += nearest < 1e-5 ? 1 : 0;
    }
    EXPECT_GT(vertices, 20U) << k;
  }
}

/// Moves the nodes themselves, as applications do that place a body.
void moveNodes(btSoftBody& body, const btVector3& by) {
  for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_x += by;
  body.updateBounds();
}

TEST(SearchesOutsideOfSteps, FindContactsWhereNodesHaveBeenPut) {
  for (const int steps : {0, 3}) {
    SurroundedBall at(-1);
    for (int k = 0; k < steps; ++k) at.step();
    btSoftBody& body = at.ball.body->body();
    const auto search = [&] {
      bullet_detail::PointContacts& contacts = bullet_detail::channelOf(body)->pointContacts();
      contacts.clear();
      at.world.deformable().performDiscreteCollisionDetection();
      for (const bullet_detail::PointContact& contact : contacts) {
        EXPECT_LT((contact.at.position(body) - contact.position).length(), 1e-5);
      }
      return contacts.size();
    };
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(search(), 0U);
      moveNodes(body, btVector3(btScalar(0.01), 0, btScalar(0.01)));
    }
    moveNodes(body, btVector3(0, 7, 0));
    EXPECT_EQ(search(), 0U);
    moveNodes(body, btVector3(0, -7, 0));
    EXPECT_GT(search(), 0U);
  }
}

}  // namespace
}  // namespace tetskin::test
