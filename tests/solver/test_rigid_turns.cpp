// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btTransformUtil.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/motion/rigid_turns.h>

#include <limits>

#include "rigid_scene.h"

namespace tetskin::test {
namespace {

btScalar largestDifference(const btMatrix3x3& a, const btMatrix3x3& b) {
  btScalar largest = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) largest = btMax(largest, btFabs(a[row][column] - b[row][column]));
  }
  return largest;
}

TEST(RigidTurns, AreBulletsButForLastDigits) {
  const btTransform from(btQuaternion(btScalar(0.1), btScalar(-0.7), btScalar(0.3), btScalar(0.6)).normalized());
  // Too slow for a sine, usual, and faster than Bullet turns anything in a step.
  for (const double speed : {0.0, 1e-4, 5e-4, 0.01, 1.0, 30.0, 150.0, 1e4}) {
    const btVector3 velocity = btVector3(btScalar(0.6), btScalar(-0.48), btScalar(0.64)) * btScalar(speed);
    btTransform bullets;
    btTransformUtil::integrateTransform(from, btVector3(1, 2, 3), velocity, btScalar(1) / 240, bullets);
    EXPECT_LE(largestDifference(bullet_detail::turned(from, velocity, btScalar(1) / 240), bullets.getBasis()),
              4 * std::numeric_limits<btScalar>::epsilon())
        << speed;
  }
}

/// A box that flies and tumbles for this many steps.
btTransform tumbled(bool deterministic, int steps) {
  DeformableWorldOptions options;
  options.deterministic = deterministic;
  tetskin::DeformableWorld world(options);
  btBoxShape shape(btVector3(1, 2, 3));
  btRigidBody box(1, nullptr, &shape, btVector3(13, 10, 5) / 3);
  box.setAngularVelocity(btVector3(3, 1, -2));
  box.setLinearVelocity(btVector3(0, 5, 0));
  world.addRigidBody(&box);
  for (int step = 0; step < steps; ++step) world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  const btTransform last = box.getWorldTransform();
  world.removeRigidBody(&box);
  return last;
}

TEST(RigidTurns, OfADeterministicWorldAreThoseOfAnyOther) {
  const btTransform bullets = tumbled(false, 240), ours = tumbled(true, 240);
  EXPECT_EQ(ours.getOrigin(), bullets.getOrigin());
  EXPECT_LE(largestDifference(ours.getBasis(), bullets.getBasis()), 1e3 * std::numeric_limits<btScalar>::epsilon());
  EXPECT_GT(largestDifference(ours.getBasis(), btMatrix3x3::getIdentity()), btScalar(0.5));
}

TEST(RigidTurns, OfADeterministicWorldAreMadeByItsOwnArithmetic) {
  DeformableWorldOptions options;
  options.deterministic = true;
  tetskin::DeformableWorld world(options);
  btSphereShape shape(1);
  btRigidBody ball(1, nullptr, &shape, btVector3(1, 1, 1));
  ball.setAngularVelocity(btVector3(3, 1, -2));
  world.addRigidBody(&ball);
  for (int step = 0; step < 100; ++step) {
    const btTransform before = ball.getWorldTransform();
    world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    const btMatrix3x3 expected = bullet_detail::turned(before, ball.getAngularVelocity(), btScalar(1) / 240);
    EXPECT_EQ(ball.getWorldTransform().getBasis(), expected);
    EXPECT_EQ(ball.getInterpolationWorldTransform().getBasis(), expected);
  }
  world.removeRigidBody(&ball);
}

TEST(RigidTurns, LeaveWhatSleepsAndWhatIsFixedAsItIs) {
  DeformableWorldOptions options;
  options.deterministic = true;
  tetskin::DeformableWorld world(options);
  btSphereShape shape(1);
  btRigidBody asleep(1, nullptr, &shape, btVector3(1, 1, 1)), fixed(0, nullptr, &shape);
  const btTransform there(btQuaternion(btScalar(0.1), btScalar(-0.7), btScalar(0.3), btScalar(0.6)).normalized(),
                          btVector3(5, 0, 0));
  asleep.setWorldTransform(there);
  asleep.forceActivationState(ISLAND_SLEEPING);
  fixed.setWorldTransform(there);
  world.addRigidBody(&asleep);
  world.addRigidBody(&fixed);
  asleep.setAngularVelocity(btVector3(1, 0, 0));
  world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  EXPECT_EQ(asleep.getWorldTransform().getBasis(), there.getBasis());
  EXPECT_EQ(fixed.getWorldTransform().getBasis(), there.getBasis());
  world.removeRigidBody(&asleep);
  world.removeRigidBody(&fixed);
}

/// Rigid bodies of all kinds, joints and an arm, with what Bullet has done to them after some steps.
std::vector<btScalar> motionOf(bool deterministic, bool turns, int frames) {
  RigidScene scene;
  scene.world.deformableSolver().setDeterministic(deterministic);
  scene.addFloor();
  scene.addStack(6);
  scene.addKinds();
  if (turns) scene.addJoints(), scene.addArm();
  int number = 0;
  for (const auto& body : scene.bodies) {
    if (!turns) body->setAngularFactor(0);
    if (number++ % 3 == 0) body->setDamping(btScalar(0.3), btScalar(0.4));
    if (number % 4 == 0) body->setCcdMotionThreshold(btScalar(0.01)), body->setCcdSweptSphereRadius(btScalar(0.1));
    if (number % 5 == 0 && body->getInvMass() > 0) body->setLinearFactor(btVector3(1, 1, 0));
    if (number % 7 == 0) body->setGravity(btVector3(1, -3, 0));
    if (number % 11 == 0) body->setLinearVelocity(btVector3(0, -30, 0));
  }
  scene.step(frames);
  return seen(scene.world);
}

/// A deterministic world has copies of Bullet's step functions: changes in other versions of Bullet would be missing
/// there.
TEST(RigidTurns, OfADeterministicWorldLeaveAllElseAsInBullets) {
  EXPECT_EQ(motionOf(true, false, 40), motionOf(false, false, 40));
  const std::vector<btScalar> own = motionOf(true, true, 6), bullets = motionOf(false, true, 6);
  ASSERT_EQ(own.size(), bullets.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    ASSERT_NEAR(own[k], bullets[k], 1e-3 * (1 + std::abs(bullets[k]))) << k;
  }
}

}  // namespace
}  // namespace tetskin::test
