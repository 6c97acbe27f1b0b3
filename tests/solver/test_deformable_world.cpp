// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <limits>

#include "deformable_test.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

void addPlane(Rigids& rigids) {
  rigids.add(rigids.shape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0, btVector3(0, 0, 0));
}

/// The positions of a cage's nodes after one second, in which it falls on the world's floor and pushes a ball aside.
std::vector<btVector3> landed(btDeformableMultiBodyDynamicsWorld& world) {
  Rigids rigids(world);
  addPlane(rigids);
  rigids.add(rigids.shape<btSphereShape>(btScalar(0.2)), 1, btVector3(btScalar(0.3), btScalar(0.2), 0));
  const auto body = DeformableBody::add(world, smallCageAbove(1)).value();
  for (int frame = 0; frame < 60; ++frame) world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  return nodesOf(body->body());
}

/// Bullet keeps the two triangles of a plane from where body and plane have met first.
TEST(DeformableWorld, ABodySlidesAlongAPlaneAnyFar) {
  tetskin::DeformableWorld world;
  Rigids rigids(world);
  addPlane(rigids);
  SoftBodyOptions options;
  options.friction = 0;
  const auto body = DeformableBody::add(world, smallCageAbove(btScalar(0.1)), options).value();
  body->body().addVelocity(btVector3(10, 0, 0));
  for (int step = 0; step < 480; ++step) world.stepSimulation(btScalar(1) / 240, 0);
  btVector3 low, high;
  body->body().getAabb(low, high);
  EXPECT_GT(low.x(), 15);
  EXPECT_NEAR(low.y(), 0, 0.05);
}

TEST(DeformableWorld, AFloorThatIsTurnedRubsAgainstTheWay) {
  for (const btScalar angle : {btScalar(0), btScalar(1), btScalar(2.5)}) {
    tetskin::DeformableWorld world(DeformableWorldOptions{btVector3(0, -10, 0), nullptr});
    btBoxShape box(btVector3(20, 1, 20));
    btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &box));
    floor.setWorldTransform(btTransform(btQuaternion(btVector3(0, 1, 0), angle), btVector3(0, -1, 0)));
    floor.setFriction(1);
    world.addRigidBody(&floor);
    SoftBodyOptions options;
    options.friction = 0.3;
    const auto body = DeformableBody::add(world, smallCageAbove(btScalar(0.02)), options).value();
    for (int step = 0; step < 60; ++step) world.stepSimulation(btScalar(1) / 240, 0);
    const auto centre = [&] {
      btVector3 low, high;
      body->body().getAabb(low, high);
      return (low + high) / 2;
    };
    const btVector3 from = centre();
    body->body().addVelocity(btVector3(3, 0, 0));
    for (int step = 0; step < 480; ++step) world.stepSimulation(btScalar(1) / 240, 0);
    const btVector3 way = centre() - from;
    EXPECT_NEAR(way.x(), 9 / (2 * 0.3 * 10), 0.1) << angle << ": v^2 / (2 mu g)";
    EXPECT_NEAR(way.z(), 0, 0.02) << angle;
    world.removeRigidBody(&floor);
  }
}

btSoftBody::Node* nodeToMove = nullptr;

TEST(DeformableWorld, ANodeThatTheApplicationMovesWithinAStepStaysThere) {
  tetskin::DeformableWorld world(DeformableWorldOptions{btVector3(0, 0, 0), nullptr});
  btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
  btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
  world.addRigidBody(&floor);
  const auto body = DeformableBody::add(world, smallCageAbove(1)).value();
  static_cast<btCollisionDispatcher*>(world.getDispatcher())
      ->setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
        if (nodeToMove) nodeToMove->m_x += btVector3(btScalar(0.01), 0, 0);
        nodeToMove = nullptr;
        btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
      });
  world.stepSimulation(btScalar(1) / 240, 0);
  nodeToMove = &body->body().m_nodes[0];
  const btVector3 before = nodeToMove->m_x;
  world.stepSimulation(btScalar(1) / 240, 0);
  EXPECT_EQ(nodeToMove, nullptr);
  EXPECT_LT((body->body().m_nodes[0].m_x - before - btVector3(btScalar(0.01), 0, 0)).length(), 1e-5);
  world.removeRigidBody(&floor);
}

/// A cube of this size that lies on a floor, a plane through the origin if none is given.
class LyingCube {
 public:
  explicit LyingCube(double size, btCollisionShape* shape = nullptr, double top = 0.0)
      : floor_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape ? shape : &plane_)) {
    floor_.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, static_cast<btScalar>(-top), 0)));
    world_.addRigidBody(&floor_);
    TetMesh cage = lifted(latticeCage(2, 2, 2, size / 2), 0.1 * size);
    body_ = DeformableBody::add(world_, cage).value();
  }
  ~LyingCube() { world_.removeRigidBody(&floor_); }
  LyingCube(const LyingCube&) = delete;
  LyingCube& operator=(const LyingCube&) = delete;

  tetskin::DeformableWorld& world() { return world_; }
  btSoftBody& body() { return body_->body(); }
  void step(double seconds, int steps = 1) {
    const auto whole = static_cast<btScalar>(seconds);
    world_.stepSimulation(whole, steps, whole / static_cast<btScalar>(steps));
  }

 private:
  btStaticPlaneShape plane_{btVector3(0, 1, 0), 0};
  btRigidBody floor_;
  tetskin::DeformableWorld world_;
  std::unique_ptr<DeformableBody> body_;
};

/// Within a step of 1/60 s, gravity moves the smallest of these by eleven times its size.
TEST(DeformableWorld, BodiesOfAnySizeLandAndFallAsleep) {
  for (const double size : {2.5e-4, 1e-3, 5e-3, 0.1}) {
    for (const int steps : {1, 4}) {
      LyingCube cube(size);
      int frames = 0;
      for (; frames < 480 && cube.body().isActive(); ++frames) cube.step(1.0 / 60.0, steps);
      EXPECT_LT(frames, 480) << size << ' ' << steps;
      EXPECT_NEAR(lowest(cube.body()), 0.03 * size, 0.04 * size) << size << ' ' << steps;
    }
  }
}

/// An application that was stopped passes the time in which it was as one step.
TEST(DeformableWorld, WhatLiesOnAFloorStaysThereInAnyStep) {
  btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
  btBoxShape box(btVector3(4, btScalar(0.5), 4));
  btTriangleMesh triangles;
  triangles.addTriangle(btVector3(-4, 0, -4), btVector3(-4, 0, 4), btVector3(4, 0, 4));
  triangles.addTriangle(btVector3(-4, 0, -4), btVector3(4, 0, 4), btVector3(4, 0, -4));
  btBvhTriangleMeshShape mesh(&triangles, true);
  for (btCollisionShape* shape : std::vector<btCollisionShape*>{&plane, &box, &mesh}) {
    for (const double seconds : {0.1, 0.5, 2.0}) {
      constexpr double kSize = 0.5;
      LyingCube cube(kSize, shape, shape == &box ? 0.5 : 0.0);
      cube.body().setActivationState(DISABLE_DEACTIVATION);
      for (int frame = 0; frame < 120; ++frame) cube.step(1.0 / 60.0, 4);
      const double before = lowest(cube.body());
      for (const int steps : {1, 4}) {
        cube.step(seconds, steps);
        EXPECT_NEAR(lowest(cube.body()), before, 0.01 * kSize) << shape->getName() << ' ' << seconds << ' ' << steps;
        EXPECT_LT(rmsSpeed(cube.body()), 0.02) << shape->getName() << ' ' << seconds << ' ' << steps;
      }
    }
  }
}

TEST(DeformableWorld, StepsAreDividedWhereABodyIsTooSmallForThemAlone) {
  struct Steps {
    int count = 0;
    btScalar seconds = 0;
  };
  const auto count = [](btDynamicsWorld* world, btScalar seconds) {
    auto& steps = *static_cast<Steps*>(world->getWorldUserInfo());
    ++steps.count;
    steps.seconds += seconds;
  };
  for (const double size : {0.1, 1e-3}) {
    LyingCube cube(size);
    Steps steps;
    cube.world().setInternalTickCallback(count, &steps);
    for (int frame = 0; frame < 10; ++frame) cube.step(1.0 / 60.0, 4);
    EXPECT_EQ(steps.count, size == 0.1 ? 40 : 80) << size;
    EXPECT_NEAR(steps.seconds, 10.0 / 60.0, 1e-4) << size;
  }
}

TEST(DeformableWorld, ABodysOwnGravityDividesSteps) {
  tetskin::DeformableWorld world(DeformableWorldOptions{btVector3(0, btScalar(-1e4), 0), nullptr});
  const auto body = DeformableBody::add(world, smallCageAbove(1)).value();
  const auto stepsWith = [&](btScalar gravity) {
    EXPECT_TRUE(body->setGravity(btVector3(0, gravity, 0)).ok());
    return world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  };
  EXPECT_EQ(stepsWith(-10), 4);
  EXPECT_EQ(stepsWith(btScalar(-1e4)), 8);
  EXPECT_EQ(stepsWith(0), 4);
}

TEST(DeformableWorld, IsNotHarmedByTimesThatAreNone) {
  constexpr btScalar kNaN = std::numeric_limits<btScalar>::quiet_NaN();
  constexpr btScalar kInfinite = std::numeric_limits<btScalar>::infinity();
  tetskin::DeformableWorld world;
  const auto body = DeformableBody::add(world, smallCageAbove(1)).value();
  const btVector3 before = body->body().m_nodes[0].m_x;
  for (const btScalar time : {kNaN, kInfinite, -kInfinite, btScalar(-1)}) {
    for (const int steps : {0, 1, 4}) EXPECT_EQ(world.stepSimulation(time, steps), 0);
    EXPECT_EQ(world.stepSimulation(btScalar(0.1), 1, time), 0);
  }
  EXPECT_EQ(world.stepSimulation(btScalar(0.1), 1, 0), 0);
  EXPECT_EQ(body->body().m_nodes[0].m_x, before);
  EXPECT_EQ(world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240), 4);
  EXPECT_LT(body->body().m_nodes[0].m_x.y(), before.y());
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
  DeformableWorldOptions options;
  options.rigidForces = RigidForceModel::DeformableWorld;
  tetskin::DeformableWorld world(options);
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
