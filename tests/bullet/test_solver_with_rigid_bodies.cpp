// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies and dynamic rigid ones that push each other, in the library's solver.
#include "rigid_bodies.h"

namespace tetskin {
namespace {

using test::added;
using test::ball;
using test::FlyingBlock;
using test::forEachSubstep;
using test::latticeCage;
using test::momentumOf;
using test::Rigid;
using test::step;

TEST(SolverWithRigidBodies, TheyTakeTheMomentumThatTheBodyLoses) {
  for (const double mass : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    for (const double aside : {0.0, 0.2}) {
      FlyingBlock of;
      Rigid rigid(of.world, ball(), static_cast<btScalar>(mass), btVector3(static_cast<btScalar>(aside), 4, 0));
      of.body().setVelocity(btVector3(0, -2, 0));
      const btVector3 before = momentumOf(of.body());
      double given = 0.0, most = 0.0;
      forEachSubstep(of.world, 240, [&] {
        given = std::max(given, static_cast<double>(rigid.momentum().length()));
        most = std::max(most, static_cast<double>((momentumOf(of.body()) + rigid.momentum() - before).length()));
      });
      EXPECT_GT(given, 0.9 * std::min(1.0, mass)) << mass;
      EXPECT_LT(most, 0.01 * 2.0) << mass << " " << aside;
    }
  }
}

TEST(SolverWithRigidBodies, NothingGainsEnergyByAnImpact) {
  for (const double mass : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    FlyingBlock of;
    Rigid rigid(of.world, ball(), static_cast<btScalar>(mass), btVector3(btScalar(0.1), 4, 0));
    of.body().setVelocity(btVector3(0, -2, 0));
    const double impact = 0.5 * 4.0;
    double least = impact, risen = 0.0;
    forEachSubstep(of.world, 240, [&] {
      const double energy = test::kineticEnergyOf(of.body()) + test::elasticEnergyIn(of.world) + rigid.kineticEnergy();
      least = std::min(least, energy);
      risen = std::max(risen, energy - least);
    });
    EXPECT_LT(least, 0.999 * impact) << mass;
    EXPECT_LT(risen, 0.01 * impact) << mass;
  }
}

TEST(SolverWithRigidBodies, TwoBodiesPushOneFromBothSides) {
  FlyingBlock of;
  TetMesh above = latticeCage(3, 3, 3, 0.3);
  for (Eigen::Vector3d& p : above.nodes) p += Eigen::Vector3d(-0.45, 2.1, -0.45);
  const auto other = added(of.world, above);
  Rigid rigid(of.world, ball(), btScalar(0.1), btVector3(0, 4, 0));
  of.body().setVelocity(btVector3(0, -2, 0));
  other->body().setVelocity(btVector3(0, 2, 0));
  double most = 0.0, fastest = 0.0;
  forEachSubstep(of.world, 240, [&] {
    const btVector3 all = momentumOf(of.body()) + momentumOf(other->body()) + rigid.momentum();
    most = std::max(most, static_cast<double>(all.length()));
    fastest = std::max(fastest, static_cast<double>(rigid.body->getLinearVelocity().length()));
  });
  // What is left of 2 kg m/s: stopped, or thrown back.
  EXPECT_GT(momentumOf(of.body()).y(), -0.1);
  EXPECT_LT(momentumOf(other->body()).y(), 0.1);
  EXPECT_LT(most, 1e-4 * 4.0);
  EXPECT_LT(fastest, 4.0);
}

TEST(SolverWithRigidBodies, LockedFactorsStayLocked) {
  FlyingBlock of;
  Rigid rigid(of.world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.1), btScalar(0.4))), 1,
              btVector3(btScalar(0.6), 4, 0));
  rigid.body->setLinearFactor(btVector3(1, 0, 1));
  rigid.body->setAngularFactor(btVector3(1, 1, 0));
  of.body().setVelocity(btVector3(0, -2, 0));
  forEachSubstep(of.world, 120, [&] {
    ASSERT_NEAR(rigid.body->getLinearVelocity().y(), 0, 1e-12);
    ASSERT_NEAR(rigid.body->getAngularVelocity().z(), 0, 1e-3);  // Bullet's own gyroscopic forces
  });
  EXPECT_GT(momentumOf(of.body()).y(), 0);  // as from a wall
}

/// Of which the solve knows nothing: the joint's answer would be lost.
TEST(SolverWithRigidBodies, HangOnTheirJoints) {
  FlyingBlock of;
  Rigid rigid(of.world, ball(), btScalar(0.1), btVector3(0, 4, 0));
  btPoint2PointConstraint joint(*rigid.body, btVector3(0, 0, 0));
  of.world.deformable().addConstraint(&joint);
  of.body().setVelocity(btVector3(0, -2, 0));
  double farthest = 0.0;
  forEachSubstep(of.world, 120, [&] {
    const btVector3 away = rigid.body->getWorldTransform().getOrigin() - btVector3(0, 4, 0);
    farthest = std::max(farthest, static_cast<double>(away.length()));
  });
  EXPECT_GT(momentumOf(of.body()).y(), -1.8);  // it was met
  EXPECT_LT(farthest, 0.02);
  of.world.deformable().removeConstraint(&joint);
}

TEST(SolverWithRigidBodies, LieOnBodiesAndBodiesOnThem) {
  for (const double mass : {0.1, 1.0, 3.0}) {
    FlyingBlock of(0.05);
    of.world.deformable().setGravity(btVector3(0, -10, 0));
    Rigid on(of.world, std::make_unique<btBoxShape>(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3))),
             static_cast<btScalar>(mass), btVector3(0, btScalar(1.2), 0));
    step(of.world, 300);
    const double height = on.height();
    double most = 0.0;
    forEachSubstep(of.world, 60, [&] { most = std::max(most, std::abs(on.height() - height)); });
    EXPECT_GT(height, 0.7) << mass;
    EXPECT_LT(height, 1.1) << mass;
    EXPECT_LT(most, 0.002) << mass;
  }
  for (const double mass : {1.0, 3.0}) {
    // On the floor, which has a part in where the box goes.
    FlyingBlock of(0.35);
    of.world.deformable().setGravity(btVector3(0, -10, 0));
    Rigid under(of.world, std::make_unique<btBoxShape>(btVector3(btScalar(0.6), btScalar(0.15), btScalar(0.6))),
                static_cast<btScalar>(mass), btVector3(0, btScalar(0.15), 0));
    step(of.world, 180);
    EXPECT_NEAR(under.height(), 0.15, 0.01) << mass;
    EXPECT_GT(test::lowest(of.body()), 0.28) << mass;
    EXPECT_LT(test::rmsSpeed(of.body()), 0.02) << mass;
  }
}

}  // namespace
}  // namespace tetskin
