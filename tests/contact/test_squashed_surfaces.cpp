// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces of soft bodies that are squashed flat by rigid ones, far more than they can carry.
#include "contact_test.h"
#include "solver/recorded_forces.h"

namespace tetskin::test {
namespace {

constexpr btScalar kStep = btScalar(1) / 240;

TEST(SquashedSurfaces, ComeToRestAndCarryTheWholeWeight) {
  for (const double ratio : {100.0, 300.0}) {
    TetskinWorld world;
    const btVector3 half(5, btScalar(0.5), 5);
    Obstacle floor(world, std::make_unique<btBoxShape>(half), placeAt(btVector3(0, btScalar(-0.5), 0)));
    TriangleMesh mesh = ballMesh(12, 0.3);
    SoftBodyOptions light;
    light.mass = 0.1;
    TouchingBody ball(world, std::move(mesh), btVector3(0, btScalar(0.31), 0), {}, light);
    Obstacle plate(world, std::make_unique<btBoxShape>(btVector3(btScalar(0.8), btScalar(0.05), btScalar(0.8))),
                   placeAt(btVector3(0, btScalar(0.7), 0)), static_cast<btScalar>(0.1 * ratio));
    plate.body().setActivationState(DISABLE_DEACTIVATION);
    plate.body().setAngularFactor(0);  // otherwise it tips over, and lies on the floor
    auto record = ForceRecord::add(world.deformable()).value();
    for (int k = 0; k < 1200; ++k) world.deformable().stepSimulation(kStep, 0, kStep);
    ASSERT_LT(ball.height(), 0.02);
    for (int k = 0; k < 60; ++k) {
      world.deformable().stepSimulation(kStep, 0, kStep);
      EXPECT_LT(fastestOf(ball.body->body()), 0.01 * kBodySize) << ratio;
      const double weight = 0.1 * ratio * static_cast<double>(world.deformable().getGravity().length());
      const double carried = static_cast<double>(record->forcesOn(plate.body()).total().force.y());
      EXPECT_NEAR(carried / weight, 1.0, 0.01) << ratio;
    }
  }
}

}  // namespace
}  // namespace tetskin::test
