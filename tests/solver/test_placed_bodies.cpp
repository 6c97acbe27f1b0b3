// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies that are put elsewhere in their motion, or back to their start.
#include <BulletSoftBody/btDeformableBodySolver.h>

#include "deformable_test.h"
#include "support/bars.h"

namespace tetskin::test {
namespace {

constexpr btScalar kPlacedFrame = btScalar(1) / 60, kHigh = 30;

std::vector<btScalar> stateOf(const btSoftBody& body) {
  std::vector<btScalar> numbers;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    for (const btVector3& v : {node.m_x, node.m_v}) numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  }
  return numbers;
}

/// The largest distance of the nodes of one body from those of another, taken by a motion.
double farthest(const btSoftBody& a, const btSoftBody& b, const btTransform& motion) {
  double maximum = 0;
  for (int n = 0; n < a.m_nodes.size(); ++n) {
    maximum = std::max<double>(maximum, (a.m_nodes[n].m_x - motion * b.m_nodes[n].m_x).length());
  }
  return maximum;
}

struct PlacedWorld : TetskinWorld {
  explicit PlacedWorld(const btVector3& gravityOfAll = btVector3(0, 0, 0)) { deformable().setGravity(gravityOfAll); }
};

/// A bar that is thrown, spins, and swings.
std::unique_ptr<DeformableBody> thrownBar(EmptyWorld& world, SoftBodyOptions options = {}) {
  TetMesh bar = lifted(makeBox({6, 2, 2}, {1.2, 0.4, 0.4}), kHigh);
  if (!options.youngsModulus) options.youngsModulus = 2e4;
  std::unique_ptr<DeformableBody> body = added(world, bar, options);
  btSoftBody& soft = body->body();
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    btSoftBody::Node& node = soft.m_nodes[n];
    const btVector3 arm = node.m_x - btVector3(btScalar(0.6), kHigh + btScalar(0.2), btScalar(0.2));
    if (node.m_im > 0) node.m_v = node.m_vn = btVector3(0, 3, 1).cross(arm) + btVector3(1, 5 * arm.x() * arm.x(), 0);
  }
  return body;
}

// ---- teleport

TEST(Teleports, GoOnWithTheMotionThere) {
  const btTransform motion(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(1.5)), btVector3(5, -3, 2));
  for (const double damping : {0.0, 0.02}) {
    PlacedWorld world;
    SoftBodyOptions options;
    options.stiffnessDamping = damping;
    const auto here = thrownBar(world, options), there = thrownBar(world, options);
    step(world, 30);
    ASSERT_TRUE(there->teleport(motion).ok());
    const double energy = kineticEnergyOf(here->body());
    EXPECT_NEAR(kineticEnergyOf(there->body()), energy, 1e-5 * energy);
    EXPECT_LT(farthest(there->body(), here->body(), motion), 1e-5);
    step(world, 60);
    EXPECT_LT(farthest(there->body(), here->body(), motion), 2e-4) << damping;
  }
}

TEST(Teleports, ChangeNothingBesideThePlaceWhereNothingIsRounded) {
  PlacedWorld world;
  const auto here = thrownBar(world), there = thrownBar(world);
  step(world, 30);
  ASSERT_TRUE(there->teleport(btTransform::getIdentity()).ok());
  step(world, 30);
  EXPECT_EQ(stateOf(here->body()), stateOf(there->body()));
}

TEST(Teleports, TakeLedPinsAlong) {
  PlacedWorld world;
  SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& rest) { return rest.x() < 0.01; };
  const auto here = thrownBar(world, options), there = thrownBar(world, options);
  const btTransform motion(btQuaternion(btVector3(0, 1, 0), btScalar(1.2)), btVector3(20, 0, 0));
  const auto lead = [&](DeformableBody& body, const btVector3& by) {
    for (int n = 0; n < body.body().m_nodes.size(); ++n) {
      if (body.isPinned(n)) {
        EXPECT_TRUE(body.setPinnedPosition(n, body.body().m_nodes[n].m_x + by).ok());
      }
    }
  };
  const btVector3 way(btScalar(0.03), 0, btScalar(0.01));
  for (int frame = 0; frame < 60; ++frame) {
    lead(*here, way);
    lead(*there, frame <= 30 ? way : motion.getBasis() * way);
    if (frame == 30) {
      ASSERT_TRUE(there->teleport(motion).ok());  // with this frame's way before it
    }
    step(world, 1);
  }
  EXPECT_LT(farthest(there->body(), here->body(), motion), 2e-4);
}

TEST(Teleports, RefuseWhatIsNoRigidMotion) {
  PlacedWorld world;
  const auto body = thrownBar(world);
  const std::vector<btScalar> before = stateOf(body->body());
  btTransform motion = btTransform::getIdentity();
  motion.setBasis(btMatrix3x3(-1, 0, 0, 0, 1, 0, 0, 0, 1));
  EXPECT_EQ(body->teleport(motion).code, StatusCode::InvalidOption);
  motion.setBasis(btMatrix3x3(2, 0, 0, 0, 2, 0, 0, 0, 2));
  EXPECT_EQ(body->teleport(motion).code, StatusCode::InvalidOption);
  EXPECT_EQ(body->teleport(btTransform(btQuaternion(0, 0, 0), btVector3(0, NAN, 0))).code, StatusCode::InvalidOption);
  for (const double far : {2e18, 1e30}) {  // no surface follows there
    motion = btTransform(btQuaternion::getIdentity(), btVector3(0, btScalar(far), 0));
    EXPECT_EQ(body->teleport(motion).code, StatusCode::InvalidOption) << far;
  }
  EXPECT_EQ(stateOf(body->body()), before);
}

/// Bullet's forces are not quite the same in all directions.
TEST(Teleports, OfBulletsForcesTurnVelocities) {
  EmptyWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  SoftBodyOptions options;
  options.forceModel = ForceModel::LinearElasticity;
  options.youngsModulus = 500;
  const auto here = thrownBar(world, options), there = thrownBar(world, options);
  const btTransform motion(btQuaternion(btVector3(0, 1, 0), btScalar(1.2)), btVector3(20, 0, 0));
  step(world, 5);
  ASSERT_TRUE(there->teleport(motion).ok());
  EXPECT_LT(farthest(there->body(), here->body(), motion), 1e-5);
  for (int n = 0; n < here->body().m_nodes.size(); ++n) {
    const btVector3 turned = motion.getBasis() * here->body().m_nodes[n].m_v;
    EXPECT_LT((there->body().m_nodes[n].m_v - turned).length(), 1e-5);
  }
}

// ---- reset

/// Four bars that do not touch; the second one starts again.
template <class Create>
void expectRepeats(const Create& create) {
  std::vector<std::vector<btScalar>> first;
  std::vector<btScalar> others[2];
  for (const bool resets : {false, true}) {
    PlacedWorld world(btVector3(0, -10, 0));
    std::vector<std::unique_ptr<DeformableBody>> bodies;
    for (int k = 0; k < 4; ++k) bodies.push_back(create(world, k));
    const auto frame = [&] {
      world.deformable().stepSimulation(kPlacedFrame, 4, kPlacedFrame / 4);
      return stateOf(bodies[1]->body());
    };
    for (int f = 0; f < 60; ++f) {
      const auto now = frame();
      if (!resets) first.push_back(now);
    }
    if (resets) {
      ASSERT_TRUE(bodies[1]->reset().ok());
    }
    for (std::size_t f = 0; f < 60; ++f) {
      const auto now = frame();
      if (resets) {
        ASSERT_EQ(now, first[f]) << "frame " << f;
      }
    }
    for (const int k : {0, 2, 3}) {
      const auto state = stateOf(bodies[static_cast<std::size_t>(k)]->body());
      others[resets].insert(others[resets].end(), state.begin(), state.end());
    }
  }
  EXPECT_EQ(others[0], others[1]);
}

std::unique_ptr<DeformableBody> bodyAt(EmptyWorld& world, TetMesh cage, int place, const SoftBodyOptions& options) {
  for (Eigen::Vector3d& p : cage.nodes) p.x() += 3 * place;
  return added(world, cage, options);
}

TEST(Resets, OfHeldBarsRepeatTheirSwing) {
  for (const double stiffness : {50.0, 3000.0}) {
    SoftBodyOptions options;
    options.relativeStiffness = stiffness;
    TetMesh bar = lifted(makeBox({6, 2, 2}, {1.2, 0.4, 0.4}), 5);
    expectRepeats([&](EmptyWorld& world, int k) {
      auto body = bodyAt(world, bar, k, options);
      for (int n = 0; n < body->body().m_nodes.size(); ++n) {
        if (body->body().m_nodes[n].m_x.x() < btScalar(3 * k + 0.01)) {
          EXPECT_TRUE(body->setPinned(n).ok());
        }
      }
      return body;
    });
  }
}

TEST(Resets, OfWhatHasLandedRepeatTheFall) {
  expectRepeats([&](EmptyWorld& world, int k) { return bodyAt(world, smallCageAbove(0.2), k, {}); });
}

TEST(Resets, OfASleeperWakesIt) {
  PlacedWorld world(btVector3(0, -10, 0));
  const auto body = bodyAt(world, smallCageAbove(0.02), 0, {});
  for (int f = 0; f < 600 && body->body().isActive(); ++f) step(world, 1);
  ASSERT_FALSE(body->body().isActive());
  ASSERT_TRUE(body->reset().ok());
  EXPECT_TRUE(body->body().isActive());
  EXPECT_NEAR(lowest(body->body()), 0.02, 1e-6);
  for (int f = 0; f < 600 && body->body().isActive(); ++f) step(world, 1);
  EXPECT_FALSE(body->body().isActive());
}

TEST(Resets, BringLedPinsBack) {
  PlacedWorld world(btVector3(0, -10, 0));
  TetMesh bar = makeBox({6, 2, 2}, {1.2, 0.4, 0.4});
  const auto body = bodyAt(world, bar, 0, {});
  ASSERT_TRUE(body->setPinned(0).ok());
  const btVector3 start = body->body().m_nodes[0].m_x;
  for (int f = 0; f < 10; ++f) {
    ASSERT_TRUE(body->setPinnedPosition(0, body->body().m_nodes[0].m_x + btVector3(0, btScalar(0.05), 0)).ok());
    step(world, 1);
  }
  ASSERT_TRUE(body->reset().ok());
  step(world, 5);
  EXPECT_EQ(body->body().m_nodes[0].m_x, start);
  EXPECT_TRUE(body->isPinned(0));
}

TEST(Resets, WakeWhatLiesOnTheBody) {
  PlacedWorld world(btVector3(0, -10, 0));
  const auto block = bodyAt(world, smallCageAbove(0.0), 0, {});
  btBoxShape shape(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.2)));
  btRigidBody box(btScalar(0.3), nullptr, &shape, btVector3(btScalar(0.001), btScalar(0.001), btScalar(0.001)));
  btTransform above(btQuaternion::getIdentity(), btVector3(btScalar(0.3), btScalar(0.75), btScalar(0.45)));
  box.setWorldTransform(above);
  box.setInterpolationWorldTransform(above);
  world.deformable().addRigidBody(&box);
  for (int f = 0; f < 600 && (box.isActive() || block->body().isActive()); ++f) step(world, 1);
  ASSERT_FALSE(box.isActive());
  ASSERT_TRUE(block->teleport(btTransform(btQuaternion::getIdentity(), btVector3(5, 0, 0))).ok());
  step(world, 60);
  EXPECT_NEAR(box.getWorldTransform().getOrigin().y(), 0.1, 0.05);
  world.deformable().removeRigidBody(&box);
}

TEST(Resets, RefuseABodyThatWasScaled) {
  PlacedWorld world(btVector3(0, -10, 0));
  const auto body = bodyAt(world, smallCageAbove(1), 0, {});
  step(world, 3);
  body->body().scale(btVector3(2, 2, 2));
  const std::vector<btScalar> before = stateOf(body->body());
  EXPECT_EQ(body->reset().code, StatusCode::InvalidOption);
  step(world, 1);
  EXPECT_EQ(body->reset().code, StatusCode::InvalidOption);
}

TEST(Resets, AreRefusedWithoutAWorldAndWithinAStep) {
  PlacedWorld world(btVector3(0, -10, 0));
  const auto body = bodyAt(world, smallCageAbove(1), 0, {});
  static StatusCode within[2];
  static DeformableBody* of = nullptr;
  of = body.get();
  world.deformable().setInternalTickCallback([](btDynamicsWorld*, btScalar) {
    within[0] = of->reset().code;
    within[1] = of->teleport(btTransform::getIdentity()).code;
  });
  step(world, 1);
  world.deformable().setInternalTickCallback(nullptr);
  EXPECT_EQ(within[0], StatusCode::InvalidOption);
  EXPECT_EQ(within[1], StatusCode::InvalidOption);
  world.deformable().removeSoftBody(&body->body());
  EXPECT_EQ(body->reset().code, StatusCode::InvalidOption);
  EXPECT_EQ(body->teleport(btTransform::getIdentity()).code, StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin::test
