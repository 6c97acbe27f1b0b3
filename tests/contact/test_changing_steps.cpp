// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rest does not depend on the step: an application that passes the time of each frame as one step has steps of any
// length, and resting bodies stay in place.
#include "contact_test.h"
#include "solver/recorded_forces.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Seconds of the k-th step.
using Steps = std::function<double(int k)>;

struct Pattern {
  const char* name;
  Steps steps;
};

std::vector<Pattern> patterns() {
  return {{"8 and 16 ms in turn", [](int k) { return k % 2 ? 0.008 : 0.016; }},
          {"each tenth twice as long", [](int k) { return k % 10 ? 1.0 / 60 : 1.0 / 30; }},
          {"4 to 30 ms, in no order", [](int k) { return 0.004 + 0.026 * (k * 7919 % 101) / 100.0; }},
          {"4 and 32 ms in turn", [](int k) { return k % 2 ? 0.004 : 0.032; }}};
}

void simulate(EmptyWorld& world, const Steps& steps, double seconds, const std::function<void()>& each = {}) {
  double time = 0.0;
  for (int k = 0; time < seconds; ++k) {
    const auto length = static_cast<btScalar>(steps(k));
    world.deformable().stepSimulation(length, 1, length);
    time += steps(k);
    if (each) each();
  }
}

TEST(ChangingSteps, LeaveABoxAtRestAndAsleep) {
  for (const Pattern& pattern : patterns()) {
    for (const bool bySurface : {true, false}) {
      TetskinWorld world;
      std::unique_ptr<TouchingBody> touching;
      std::unique_ptr<DeformableBody> nodes;
      if (bySurface) {
        touching =
            std::make_unique<TouchingBody>(world, boxMesh(Vector3d::Constant(0.4)), btVector3(0, btScalar(0.41), 0));
      } else {
        TetMesh cage = looseCage();
        for (Vector3d& p : cage.nodes) p.y() += 0.6;
        nodes = added(world, cage);
      }
      btSoftBody& body = bySurface ? touching->body->body() : nodes->body();
      simulate(world, pattern.steps, 6.0);
      EXPECT_FALSE(body.isActive()) << pattern.name << (bySurface ? " by its surface" : " by nodes");
    }
  }
}

TEST(ChangingSteps, LeaveWhatLiesOnARestingRigidBodyAtRest) {
  for (const Pattern& pattern : patterns()) {
    TetskinWorld world;
    Obstacle plate(world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.1), 1)),
                   placeAt(btVector3(0, btScalar(0.1), 0)), 0.5);
    TouchingBody touching(world, boxMesh(Vector3d::Constant(0.4)), btVector3(0, btScalar(0.61), 0));
    simulate(world, pattern.steps, 6.0);
    EXPECT_FALSE(touching.body->body().isActive()) << pattern.name;
    EXPECT_FALSE(plate.body().isActive()) << pattern.name;
  }
}

/// A body that is kept awake shows what sleep would hide.
TEST(ChangingSteps, ChangeNeitherTheSpeedNorTheForceOfWhatLies) {
  for (const Pattern& pattern : patterns()) {
    TetskinWorld world;
    TouchingBody touching(world, boxMesh(Vector3d::Constant(0.4)), btVector3(0, btScalar(0.41), 0));
    btSoftBody& body = touching.body->body();
    body.setActivationState(DISABLE_DEACTIVATION);
    const auto forces = forcesIn(world);
    simulate(world, pattern.steps, 4.0);
    double fastest = 0.0, most = 0.0, least = HUGE_VAL;
    simulate(world, pattern.steps, 1.0, [&] {
      fastest = std::max(fastest, fastestOf(body));
      const double force = -static_cast<double>(forces->forcesOn(floorOf(world)).total().force.y());
      most = std::max(most, force);
      least = std::min(least, force);
    });
    EXPECT_LT(fastest, 2e-3) << pattern.name;
    EXPECT_NEAR(most / kWeight, 1.0, 0.01) << pattern.name;
    EXPECT_NEAR(least / kWeight, 1.0, 0.01) << pattern.name;
  }
}

}  // namespace
}  // namespace tetskin::test
