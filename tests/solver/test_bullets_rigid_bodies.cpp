// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Effects of Bullet's deformable world on rigid bodies that its plain world does not have. The tables in
// tests/BULLET_DEFECTS.md name these tests; `RigidBodies.MoveAsInBulletsPlainWorld` compares the library.
#include "deformable_test.h"

namespace tetskin {
namespace {

/// A ball of 2 kg in Bullet's deformable world.
class Ball {
 public:
  explicit Ball(const btVector3& gravity) {
    world_.deformable().setGravity(gravity);
    body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 5, 0)));
    body.setActivationState(DISABLE_DEACTIVATION);
    world_.deformable().addRigidBody(&body);
  }
  ~Ball() { world_.deformable().removeRigidBody(&body); }
  void step() { world_.deformable().stepSimulation(btScalar(1) / 60, 1); }
  btRigidBody& floor() { return *btRigidBody::upcast(world_.deformable().getCollisionObjectArray()[0]); }

 private:
  test::EmptyWorld world_;
  btSphereShape shape_{btScalar(0.5)};

 public:
  btRigidBody body{2, nullptr, &shape_, btVector3(1, 1, 1)};
};

TEST(BulletsRigidBodies, TakeForcesTwice) {
  Ball ball(btVector3(0, 0, 0));
  for (int frame = 0; frame < 60; ++frame) {
    ball.body.applyCentralForce(btVector3(10, 0, 0));
    ball.step();
  }
  EXPECT_NEAR(ball.body.getLinearVelocity().x(), 10, 1e-3);
}

TEST(BulletsRigidBodies, TakeForcesWhereTheyAreNotSimulated) {
  Ball ball(btVector3(0, 0, 0));
  ball.body.forceActivationState(DISABLE_SIMULATION);
  ball.body.applyCentralForce(btVector3(120, 0, 0));
  ball.step();
  EXPECT_NEAR(ball.body.getLinearVelocity().x(), 1, 1e-5);
}

TEST(BulletsRigidBodies, SpinByAQuarterTurnPerStepAtMost) {
  Ball ball(btVector3(0, 0, 0));
  ball.body.setAngularVelocity(btVector3(300, 0, 0));
  ball.step();
  EXPECT_NEAR(ball.body.getAngularVelocity().x(), SIMD_HALF_PI * 60, 1e-3);
}

/// By the speed that gravity gives in a step, which contacts take for speed of the impact.
TEST(BulletsRigidBodies, ReboundFasterThanTheyFall) {
  Ball ball(btVector3(0, -12, 0));
  ball.floor().setRestitution(1);
  ball.body.setRestitution(1);
  btScalar fell = 0, rose = 0;
  for (int frame = 0; frame < 70; ++frame) {
    ball.step();
    fell = std::min(fell, ball.body.getLinearVelocity().y());
    rose = std::max(rose, ball.body.getLinearVelocity().y());
  }
  EXPECT_NEAR(rose + fell, 0.2, 1e-3);
}

}  // namespace
}  // namespace tetskin
