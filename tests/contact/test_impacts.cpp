// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/step/step.h>

#include "contact/contact_test.h"
#include "solver/recorded_forces.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.3, kDrop = 1.0, kTop = 1.0;

enum class Ground { Plane, TwoBoxes, Mesh, Kinematic };

/// A ball of 1 kg that falls from `kDrop` above ground whose top is at `kTop`, higher than the world's floor.
class BouncingBall {
 public:
  BouncingBall(double stiffness, double damping, double restitution = 0.0, Ground ground = Ground::Plane,
               double height = kDrop) {
    add(ground, restitution);
    SoftBodyOptions material;
    material.youngsModulus = stiffness;
    material.stiffnessDamping = damping;
    material.restitution = restitution;
    touching = std::make_unique<TouchingBody>(world, ballMesh(16, kRadius),
                                              btVector3(0, static_cast<btScalar>(kTop + kRadius + height), 0),
                                              SurfaceContactOptions(), material);
    start_ = this->height();
  }

  btSoftBody& body() { return touching->body->body(); }
  /// Of the ball above the ground.
  double height() { return static_cast<double>(centreOf(body()).y()) - kRadius - kTop; }
  void step(int substeps) {
    const btScalar seconds = btScalar(1) / static_cast<btScalar>(60 * substeps);
    world.deformable().stepSimulation(seconds, 1, seconds);
  }
  /// The share of its height to which it rises again.
  double rebound(int substeps) {
    double most = -HUGE_VAL;
    bool met = false;
    for (int k = 0; k < 90 * substeps; ++k) {
      step(substeps);
      met |= static_cast<double>(momentumOf(body()).y()) > 0.0;
      if (met) most = std::max(most, height());
    }
    return most / start_;
  }

  TetskinWorld world;
  std::unique_ptr<TouchingBody> touching;
  std::vector<std::unique_ptr<Rigid>> grounds;

 private:
  void add(Ground ground, double restitution) {
    const auto box = [] { return std::make_unique<btBoxShape>(btVector3(5, btScalar(kTop / 2), 5)); };
    const btScalar top = btScalar(kTop), middle = btScalar(kTop / 2);
    if (ground == Ground::Plane) keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0), 0, top, restitution);
    if (ground == Ground::TwoBoxes) {
      for (const btScalar x : {btScalar(-5), btScalar(5)}) keep(box(), x, middle, restitution);
    }
    if (ground == Ground::Mesh) {
      for (const float x : {-5.0F, 5.0F}) {
        triangles_.addTriangle(btVector3(x, 0, x), btVector3(x, 0, -x), btVector3(-x, 0, x));
      }
      keep(std::make_unique<btBvhTriangleMeshShape>(&triangles_, true), 0, top, restitution);
    }
    if (ground == Ground::Kinematic) {
      btRigidBody& body = keep(box(), 0, middle, restitution);
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      body.setActivationState(DISABLE_DEACTIVATION);
    }
  }
  btRigidBody& keep(std::unique_ptr<btCollisionShape> shape, btScalar x, btScalar y, double restitution) {
    grounds.push_back(std::make_unique<Rigid>(world.deformable(), std::move(shape), btScalar(0), btVector3(x, y, 0)));
    (*grounds.back())->setRestitution(static_cast<btScalar>(restitution));
    return **grounds.back();
  }

  btTriangleMesh triangles_;
  double start_ = 0.0;
};

/// Its own vibrations keep the rest: 64 steps per frame differ from 16 by as much. The last impact takes two steps.
TEST(Impacts, AnElasticBallRisesInAGamesStepsAsInFineOnes) {
  for (const double stiffness : {300.0, 1000.0, 3000.0, 1e5}) {
    const double fine = BouncingBall(stiffness, 0.0).rebound(32);
    EXPECT_GT(fine, 0.6) << stiffness;
    for (const int substeps : {4, 8}) {
      const double coarse = BouncingBall(stiffness, 0.0).rebound(substeps);
      EXPECT_NEAR(coarse, fine, 0.12) << stiffness << " in " << substeps;
      EXPECT_LT(coarse, 1.01);
    }
  }
}

TEST(Impacts, DampingIsTheMaterials) {
  for (const double damping : {0.002, 0.01}) {
    const double fine = BouncingBall(1000.0, damping).rebound(32), coarse = BouncingBall(1000.0, damping).rebound(4);
    EXPECT_NEAR(coarse / fine, 1.0, 0.2) << damping;
  }
  EXPECT_LT(BouncingBall(1e5, 0.1).rebound(4), 0.05) << "it hardly rises";
}

/// A stiff damped ball does not bounce without it.
TEST(Impacts, RestitutionIsTheShareOfTheSpeedOfApproachOnGroundsOfAnyKind) {
  for (const Ground ground : {Ground::Plane, Ground::TwoBoxes, Ground::Mesh, Ground::Kinematic}) {
    for (const double e : {0.7, 0.9, 1.0}) {
      const double rebound = BouncingBall(1e5, 0.05, e, ground).rebound(4);
      const double expected = std::pow(e, 4.0);  // of the height; the product is that of both objects
      // Beside the crack between two boxes, the ball is pushed to both sides.
      EXPECT_GT(rebound, expected - (ground == Ground::TwoBoxes ? 0.2 : 0.08)) << e << static_cast<int>(ground);
      EXPECT_LT(rebound, std::min(expected + (ground == Ground::TwoBoxes ? 0.1 : 0.04), 1.0))
          << e << static_cast<int>(ground);
    }
  }
}

TEST(Impacts, WhatLiesDoesNotTrembleWhateverItsRestitution) {
  for (const double stiffness : {1000.0, 1e5}) {
    BouncingBall ball(stiffness, 0.02, 1.0, Ground::Plane, 0.001);
    for (int k = 0; k < 480; ++k) ball.step(4);
    ball.body().setActivationState(DISABLE_DEACTIVATION);
    double fastest = 0.0;
    for (int k = 0; k < 240; ++k) {
      ball.step(4);
      fastest = std::max(fastest, fastestOf(ball.body()));
    }
    EXPECT_LT(fastest, 0.01) << stiffness;
  }
}

/// What comes slowly bounces if its own gravity is small, whatever the world's.
TEST(Impacts, AreToldFromRestByTheBodysOwnGravity) {
  BouncingBall ball(1e5, 0.02, 1.0, Ground::Plane, 0.01);
  EXPECT_TRUE(ball.touching->body->setGravity(btVector3(0, btScalar(-0.1), 0)).ok());
  ball.body().setVelocity(btVector3(0, btScalar(-0.05), 0));
  double fastest = -HUGE_VAL;
  for (int k = 0; k < 120; ++k) {
    ball.step(4);
    fastest = std::max(fastest, static_cast<double>(momentumOf(ball.body()).y()));
  }
  EXPECT_GT(fastest, 0.04);
  EXPECT_LT(fastest, 0.07);
}

/// What is given back acts on the partner when the floor is there to hold it.
TEST(Impacts, APartnerThatLiesIsNotPushedIntoTheFloor) {
  TetskinWorld world;
  const btScalar half = btScalar(0.15);
  const Rigid plate(world, std::make_unique<btBoxShape>(btVector3(btScalar(0.5), half, btScalar(0.5))), btScalar(0.1),
                    btVector3(0, half, 0));
  plate.body->setRestitution(1);
  SoftBodyOptions material;
  material.youngsModulus = 500.0;
  material.restitution = 1.0;
  const TouchingBody ball(world, ballMesh(16, kRadius), btVector3(0, btScalar(1.2), 0), {}, material);
  double lowest = 1.0;
  for (int k = 0; k < 240; ++k) {
    world.deformable().stepSimulation(btScalar(1) / 240, 0);
    lowest = std::min(lowest, plate.height());
  }
  EXPECT_GT(lowest, 0.15 - 0.002);
}

/// A ball and a free multibody, which is a box; no gravity.
TEST(Impacts, AMultibodyGetsAsMuchMomentumAsTheBallLoses) {
  TetskinWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  FlatMultibody multi(world, 2, btVector3(0, 0, 0));
  multi.link.setRestitution(1);
  SoftBodyOptions material;
  material.youngsModulus = 1e5;
  material.restitution = 1.0;
  const TouchingBody ball(world, ballMesh(16, kRadius), btVector3(0, 1, 0), {}, material);
  ball.body->body().setVelocity(btVector3(0, -3, 0));
  const btVector3 before = momentumOf(ball.body->body());
  for (int k = 0; k < 120; ++k) world.deformable().stepSimulation(btScalar(1) / 240, 0);
  const btVector3 after = momentumOf(ball.body->body()) + 2 * multi.body.getBaseVel();
  EXPECT_LT(static_cast<double>((after - before).length()), 1e-4 * static_cast<double>(before.length()));
  // A ball of 1 kg that hits one of 2 kg with e = 1 has -1 / 3 of its velocity, which vibrations diminish.
  EXPECT_NEAR(static_cast<double>(momentumOf(ball.body->body()).y()), 1.0, 0.1);
}

class ReplayedBall : public ReplayedScene {
 public:
  btDeformableMultiBodyDynamicsWorld& world() override { return ball_.world.deformable(); }
  void frame(int) override {
    ball_.step(8);
    const auto& impacts = Access<DeformableSolver>::impl(ball_.world.bodySolver()).impacts;
    goesOn = impacts.includes(ball_.body());
    gaveBack = !impacts.given().empty();
  }

  bool goesOn = false, gaveBack = false;

 private:
  BouncingBall ball_{1000.0, 0.001, 0.9, Ground::TwoBoxes, 0.02};
};

TEST(Impacts, SnapshotsWithinThemAreExact) {
  ReplayedBall scene;
  std::vector<int> within;
  for (int f = 0; f < 120; ++f) {
    scene.frame(f);
    if (scene.goesOn && f % 8 == 0) within.push_back(f);
    if (scene.gaveBack) within.push_back(f - 1);
  }
  ASSERT_GT(within.size(), 3U);
  expectReplays([] { return std::make_unique<ReplayedBall>(); }, 120, within, 12);
}

/// Between two steps, or within one, after what is due has been given back.
TEST(Impacts, EndWithTheirBodyOrTheirPartner) {
  for (int k = 0; k < 40; ++k) {
    for (const int what : {0, 1, 2}) {
      BouncingBall ball(1000.0, 0.0, 1.0, Ground::TwoBoxes, 0.02);
      const auto forces = forcesIn(ball.world);
      for (int s = 0; s < 14 + k; ++s) ball.step(4);
      if (what == 0) ball.touching.reset();
      if (what == 1) ball.grounds.clear();
      if (what == 2) {
        static BouncingBall* of;
        of = &ball;
        ball.world.deformable().setSolverCallback(
            [](btScalar, btDeformableMultiBodyDynamicsWorld*) { of->grounds.clear(); });
      }
      const double before = what == 0 ? 0.0 : static_cast<double>(momentumOf(ball.body()).y());
      for (int s = 0; s < 4; ++s) ball.step(4);
      ball.world.deformable().setSolverCallback(nullptr);
      if (what == 0) continue;
      const double fallen = 10.0 * 4.0 / 240.0, change = static_cast<double>(momentumOf(ball.body()).y()) - before;
      EXPECT_GT(change, -fallen - 1e-4);
      if (what == 1 && before < -0.1) {
        EXPECT_LT(change, 0.7) << "at most what was due";
      }
    }
  }
}

TEST(Impacts, GoOnWhenTheOriginIsShifted) {
  const auto speedAfter = [](bool shifts) {
    BouncingBall ball(1e5, 0.02, 1.0, Ground::TwoBoxes);
    for (int k = 0; k < 180; ++k) {
      if (shifts) {
        EXPECT_TRUE(shiftOrigin(ball.world.deformable(), btVector3(3, 0, k % 2 ? -1 : 1)).ok());
      }
      ball.step(4);
    }
    return static_cast<double>(momentumOf(ball.body()).y());
  };
  EXPECT_NEAR(speedAfter(true), speedAfter(false), 0.05);
}

}  // namespace
}  // namespace tetskin::test
