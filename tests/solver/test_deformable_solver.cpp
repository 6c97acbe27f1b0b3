// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies solved by the library's own solver that land, rest and slide, and that carry what lands on them.
#include "deformable_test.h"

#include <tetskin/solver/src/base/body_channel.h>

#include <chrono>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

using Vector = Eigen::Vector3d;

class Landing : public testing::TestWithParam<double> {};

/// Several bodies side by side, one of them pinned at a side, in steps of 1/240 s and of a frame; the parameter is the
/// stiffness in units of density x gravity x size.
TEST_P(Landing, HoldsForSeveralBodiesAndWithPins) {
  for (const int substeps : {4, 1}) {
    TetskinWorld world;
    std::vector<std::unique_ptr<DeformableBody>> bodies;
    for (int b = 0; b < 3; ++b) {
      TetMesh cage = cageAbove(0.3);
      for (Vector& p : cage.nodes) p.x() += 2.0 * b;
      SoftBodyOptions options;
      options.relativeStiffness = GetParam();
      if (b == 1) options.pinned = pinnedIn(Box3(Vector(1.9, 0.0, -1.0), Vector(2.01, 2.0, 2.0)));
      bodies.push_back(added(world, cage, options));
    }
    const auto steps = static_cast<btScalar>(substeps);
    for (int f = 0; f < 240; ++f) {
      world.deformable().stepSimulation(btScalar(1) / 60, substeps, btScalar(1) / 60 / steps);
    }
    for (const auto& body : bodies) {
      EXPECT_LT(rmsSpeed(body->body()), 0.05) << substeps;
      EXPECT_GT(lowest(body->body()), -0.005) << substeps;
    }
    EXPECT_LT(lowest(bodies[0]->body()), 0.03);  // the margin is 0.02
    EXPECT_GT(lowest(bodies[1]->body()) - lowest(bodies[0]->body()), -1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(DeformableSolver, Landing, testing::Values(50.0, 300.0, 1e4));

TEST(DeformableSolver, LetsBodiesSlideDownASlipperySlopeAndNotAStickyOne) {
  const auto slid = [](double friction) {
    TetskinWorld world;
    btBoxShape shape(btVector3(10, 1, 10));
    btRigidBody slope(0, nullptr, &shape);
    btTransform tilted(btQuaternion(btVector3(0, 0, 1), btScalar(-0.3)), btVector3(0, 3, 0));
    slope.setWorldTransform(tilted);
    slope.setInterpolationWorldTransform(tilted);
    slope.setFriction(1);
    world.deformable().addRigidBody(&slope);
    SoftBodyOptions options;
    options.friction = friction;
    options.relativeStiffness = 300.0;
    TetMesh cage = test::latticeCage(3, 2, 3, 0.2);
    for (Vector& p : cage.nodes) {
      p = toEigen(tilted * toBullet(p + Vector(0, 1.03, 0)));
    }
    const auto body = added(world, cage, options);
    const btVector3 before = body->body().m_nodes[0].m_x;
    step(world, 60);
    const double direction = static_cast<double>((body->body().m_nodes[0].m_x - before).length());
    world.deformable().removeRigidBody(&slope);
    return direction;
  };
  // a = g (sin - mu cos): 2.9 without friction, 1.0 with 0.2; the body sticks above tan(0.3) = 0.31
  EXPECT_NEAR(slid(0.0), 0.5 * 10.0 * std::sin(0.3), 0.15);
  EXPECT_NEAR(slid(0.2), 0.5 * 10.0 * (std::sin(0.3) - 0.2 * std::cos(0.3)), 0.25);
  EXPECT_LT(slid(0.6), 0.1);
}

/// Such contacts have no effect, as in Bullet's own solver.
TEST(DeformableSolver, PassesOverContactsThatAreNotANumber) {
  for (const ForceModel model : {ForceModel::Corotated, ForceModel::NeoHookean}) {
    struct : TetskinWorld {
      btRigidBody& ground() { return *floor; }
    } world;
    SoftBodyOptions options;
    options.forceModel = model;
    const auto body = added(world, cageAbove(0.1), options);
    step(world, 10);
    const bool bullets = model != ForceModel::Corotated;
    ASSERT_TRUE(bullets ? body->body().m_nodeRigidContacts.size() > 0
                        : !channelOf(body->body())->pointContacts().empty());
    world.ground().setLinearVelocity(btScalar(NAN) * btVector3(1, 1, 1));
    step(world, 1);
    for (int n = 0; n < body->body().m_nodes.size(); ++n) {
      ASSERT_TRUE(std::isfinite(body->body().m_nodes[n].m_x.length())) << n;
    }
    world.ground().setLinearVelocity(btVector3(0, 0, 0));
    step(world, 180);
    EXPECT_LT(rmsSpeed(body->body()), 0.05);
    EXPECT_NEAR(lowest(body->body()), 0.02, 0.02);
  }
}

TEST(DeformableSolver, TellsHowLongTheStagesOfItsStepsTake) {
  tetskin::DeformableWorld world;
  const DeformableSolver& solver = world.deformableSolver();
  EXPECT_EQ(solver.stepTimes().total(), 0.0);
  const auto body = DeformableBody::add(world, cageAbove(0.5)).value();
  const auto start = std::chrono::steady_clock::now();
  world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  const StepTimes first = solver.stepTimes();
  world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const StepTimes both = solver.stepTimes();
  for (double StepTimes::*stage :
       {&StepTimes::prediction, &StepTimes::rigidSearch, &StepTimes::rows, &StepTimes::system}) {
    EXPECT_GT(first.*stage, 0.0);
    EXPECT_GT(both.*stage, first.*stage);
  }
  EXPECT_EQ(both.softSearch, 0.0) << "nothing searches";
  EXPECT_LE(both.total(), elapsed.count());
}

}  // namespace
}  // namespace tetskin::test
