// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies and dynamic rigid bodies that push each other, in the library's solver.
#include "rigid_bodies.h"

namespace tetskin::test {
namespace {

TEST(SolverWithRigidBodies, NothingGainsEnergyByAnImpact) {
  for (const double mass : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    FlyingBlock item;
    Rigid rigid(item.world, ball(), static_cast<btScalar>(mass), btVector3(btScalar(0.1), 4, 0));
    item.body().setVelocity(btVector3(0, -2, 0));
    const double impact = 0.5 * 4.0;
    double minimum = impact, risen = 0.0;
    forEachSubstep(item.world, 240, [&] {
      const double energy =
          test::kineticEnergyOf(item.body()) + test::elasticEnergyIn(item.world) + rigid.kineticEnergy();
      minimum = std::min(minimum, energy);
      risen = std::max(risen, energy - minimum);
    });
    EXPECT_LT(minimum, 0.999 * impact) << mass;
    EXPECT_LT(risen, 0.01 * impact) << mass;
  }
}

TEST(SolverWithRigidBodies, TwoBodiesPushOneFromBothSides) {
  FlyingBlock item;
  TetMesh above = shifted(latticeCage(3, 3, 3, 0.3), Eigen::Vector3d(-0.45, 2.1, -0.45));
  const auto other = added(item.world, above);
  Rigid rigid(item.world, ball(), btScalar(0.1), btVector3(0, 4, 0));
  item.body().setVelocity(btVector3(0, -2, 0));
  other->body().setVelocity(btVector3(0, 2, 0));
  double maximum = 0.0, fastest = 0.0;
  forEachSubstep(item.world, 240, [&] {
    const btVector3 all = momentumOf(item.body()) + momentumOf(other->body()) + rigid.momentum();
    maximum = std::max(maximum, static_cast<double>(all.length()));
    fastest = std::max(fastest, static_cast<double>(rigid.body->getLinearVelocity().length()));
  });
  // Nothing is left of 2 kg m/s: the body has stopped or was thrown back.
  EXPECT_GT(momentumOf(item.body()).y(), -0.1);
  EXPECT_LT(momentumOf(other->body()).y(), 0.1);
  EXPECT_LT(maximum, 1e-4 * 4.0);
  EXPECT_LT(fastest, 4.0);
}

TEST(SolverWithRigidBodies, LockedFactorsStayLocked) {
  FlyingBlock item;
  Rigid rigid(item.world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.1), btScalar(0.4))), 1,
              btVector3(btScalar(0.6), 4, 0));
  rigid.body->setLinearFactor(btVector3(1, 0, 1));
  rigid.body->setAngularFactor(btVector3(1, 1, 0));
  item.body().setVelocity(btVector3(0, -2, 0));
  forEachSubstep(item.world, 120, [&] {
    ASSERT_NEAR(rigid.body->getLinearVelocity().y(), 0, 1e-12);
    ASSERT_NEAR(rigid.body->getAngularVelocity().z(), 0, 1e-3);  // changed by Bullet's own gyroscopic forces
  });
  EXPECT_GT(momentumOf(item.body()).y(), 0);  // the body bounces as if off a wall
}

TEST(SolverWithRigidBodies, LieOnBodies) {
  for (const double mass : {0.1, 1.0, 3.0}) {
    FlyingBlock item(0.05);
    item.world.deformable().setGravity(btVector3(0, -10, 0));
    Rigid on(item.world, std::make_unique<btBoxShape>(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3))),
             static_cast<btScalar>(mass), btVector3(0, btScalar(1.2), 0));
    step(item.world, 300);
    const double height = on.height();
    double maximum = 0.0;
    forEachSubstep(item.world, 60, [&] { maximum = std::max(maximum, std::abs(on.height() - height)); });
    EXPECT_GT(height, 0.7) << mass;
    EXPECT_LT(height, 1.1) << mass;
    EXPECT_LT(maximum, 0.002) << mass;
  }
}

/// Ten times its mass on a body whose nodes touch, as it gets stiffer.
TEST(SolverWithRigidBodies, AHeavyBoxOnAStiffCubeComesToRest) {
  for (const double pressure : {1e6, 1e7, 1e8, 1e9}) {
    test::TetskinWorld world;
    SoftBodyOptions options;
    options.mass = 5;
    options.youngsModulus = pressure;
    const auto body = added(world, test::smallCageAbove(0.02), options);
    Rigid box(world, std::make_unique<btBoxShape>(btVector3(1, 1, 1) * btScalar(0.2)), 50,
              btVector3(btScalar(0.3), btScalar(0.9), btScalar(0.45)));
    step(world, 160);
    EXPECT_FALSE(body->body().isActive()) << pressure;
    EXPECT_LT(box.body->getLinearVelocity().length(), 1e-4) << pressure;
    EXPECT_GT(box.height(), 0.75) << pressure;
  }
}

}  // namespace
}  // namespace tetskin::test
