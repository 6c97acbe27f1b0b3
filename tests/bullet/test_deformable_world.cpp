// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/deformable_world.h>

#include <memory>

#include "deformable_test.h"

namespace tetskin::test {
namespace {

/// Where a cage's nodes are one second after it falls on a floor of the world and pushes a ball aside.
std::vector<btVector3> landed(btDeformableMultiBodyDynamicsWorld& world) {
  btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
  btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
  btSphereShape sphere(btScalar(0.2));
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &sphere, btVector3(1, 1, 1)));
  ball.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.3), btScalar(0.2), 0)));
  world.addRigidBody(&floor);
  world.addRigidBody(&ball);
  const auto body = DeformableBody::add(world, smallCageAbove(1)).value();
  for (int frame = 0; frame < 60; ++frame) world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  std::vector<btVector3> positions;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) positions.push_back(body->body().m_nodes[n].m_x);
  world.removeRigidBody(&ball);
  world.removeRigidBody(&floor);
  return positions;
}

/// Bullet keeps the two triangles of a plane from where body and plane have met first.
TEST(DeformableWorld, ABodySlidesAlongAPlaneAnyFar) {
  tetskin::DeformableWorld world;
  btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
  btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
  world.addRigidBody(&floor);
  SoftBodyOptions options;
  options.friction = 0;
  const auto body = DeformableBody::add(world, smallCageAbove(btScalar(0.1)), options).value();
  body->body().addVelocity(btVector3(10, 0, 0));
  for (int step = 0; step < 480; ++step) world.stepSimulation(btScalar(1) / 240, 0);
  btVector3 low, high;
  body->body().getAabb(low, high);
  EXPECT_GT(low.x(), 15);
  EXPECT_NEAR(low.y(), 0, 0.05);
  world.removeRigidBody(&floor);
}

TEST(DeformableWorld, StepsAsAWorldOfTheSameObjectsDoes) {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  DeformableSolver bodySolver;
  btDeformableMultiBodyConstraintSolver solver;
  solver.setDeformableSolver(&bodySolver);
  btDeformableMultiBodyDynamicsWorld byHand(&dispatcher, &broadphase, &solver, &configuration, &bodySolver);
  byHand.setGravity(btVector3(0, btScalar(-9.81), 0));
  tetskin::DeformableWorld world;
  const std::vector<btVector3> expected = landed(byHand);
  EXPECT_EQ(landed(world), expected);
  EXPECT_LT(expected[0].y(), 1);
}

TEST(DeformableWorld, HasWhatItsOptionsSay) {
  DeformableWorldOptions options;
  options.gravity = btVector3(0, 0, -2);
  tetskin::DeformableWorld world(options);
  EXPECT_EQ(world.getGravity(), btVector3(0, 0, -2));
  EXPECT_EQ(&world.dispatcher(), world.getDispatcher());
  EXPECT_EQ(&world.broadphase(), world.getBroadphase());
  EXPECT_EQ(&world.constraintSolver(), world.getConstraintSolver());
  EXPECT_TRUE(world.deformableSolver().ownSolveActive());
}

TEST(DeformableWorld, GoesWithBodiesThatAreStillInIt) {
  btSphereShape sphere(1);
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &sphere));
  std::unique_ptr<DeformableBody> body;
  {
    tetskin::DeformableWorld world;
    world.addRigidBody(&ball);
    body = DeformableBody::add(world, smallCageAbove(1)).value();
    world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  }
  EXPECT_EQ(body->solverPath(), SolverPath::None);
}

}  // namespace
}  // namespace tetskin::test
