// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <cmath>

#include "solver/deformable_test.h"
#include "support/replays.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

constexpr double kMargin = 0.008;  // of contact
constexpr double kSide = 0.4, kHeight = 1.0, kStiff = 2e6;

/// A cube above obstacles that are still to be added.
struct FallingCube {
  explicit FallingCube(double damping = 0.0, int parts = 4, double stiffness = kStiff)
      : world(optionsOf(parts)), rigids(world) {
    SoftBodyOptions material;
    material.youngsModulus = stiffness;
    material.density = 200.0;
    material.stiffnessDamping = damping;
    cube = DeformableBody::add(world, lifted(latticeCage(4, 4, 4, kSide / 4), kHeight), material).value();
    start = height();
  }
  static DeformableWorldOptions optionsOf(int parts) {
    DeformableWorldOptions options;
    options.impactParts = parts;
    return options;
  }
  void addFloor() { rigids.add(rigids.shape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0, {0, 0, 0}); }

  double height() const { return static_cast<double>(centreOf(cube->body()).y()); }
  double speed() const { return static_cast<double>(momentumOf(cube->body()).y()); }
  int frame(int substeps = 4) {
    return world.stepSimulation(btScalar(1) / 60, substeps, btScalar(1) / static_cast<btScalar>(60 * substeps));
  }
  /// The share of its height to which it rises again.
  double rebound(int substeps) {
    double most = -HUGE_VAL;
    bool met = false;
    for (int k = 0; k < 80; ++k) {
      frame(substeps);
      met |= speed() > 0.0;
      if (met) most = std::max(most, height() - start + kHeight);
    }
    return most / kHeight;
  }
  /// Frames whose steps are divided, until it rises.
  int dividedFrames(int most = 60) {
    int divided = 0;
    for (int k = 0; k < most && !(speed() > 0.0); ++k) divided += frame() > 4 ? 1 : 0;
    return divided;
  }

  tetskin::DeformableWorld world;
  Rigids rigids;
  std::unique_ptr<DeformableBody> cube;
  double start = 0.0;
};

double reboundOnTheFloor(int substeps, int parts) {
  FallingCube cube(0.0, parts);
  cube.addFloor();
  return cube.rebound(substeps);
}

TEST(ImpactParts, AShortImpactReboundsAsInFineSteps) {
  const double fine = reboundOnTheFloor(32, 1);
  EXPECT_NEAR(reboundOnTheFloor(4, 4), fine, 0.08);
  EXPECT_GT(std::abs(reboundOnTheFloor(4, 1) - fine), 0.12) << "what they are for";
}

TEST(ImpactParts, AreTakenInTheImpactAlone) {
  FallingCube cube;
  cube.addFloor();
  const int divided = cube.dividedFrames();
  EXPECT_GE(divided, 1);
  EXPECT_LE(divided, 2);
  for (int k = 0; k < 3; ++k) cube.frame();
  for (int k = 0; k < 10; ++k) EXPECT_EQ(cube.frame(), 4) << "it rises";
}

TEST(ImpactParts, AreNotTakenByWhatDoesNotBounce) {
  FallingCube damped(0.02), never(0.0, 1), soft(0.0, 4, 2e4), clay;
  Plasticity yields;
  yields.yieldStress = 1e4;
  ASSERT_TRUE(clay.cube->setPlasticity(yields).ok());
  for (FallingCube* cube : {&damped, &never, &soft, &clay}) {
    cube->addFloor();
    for (int k = 0; k < 60; ++k) EXPECT_EQ(cube->frame(), 4);
  }
}

TEST(ImpactParts, AreNotTakenByWhatLiesOrSlides) {
  FallingCube cube;
  cube.addFloor();
  cube.rigids.bodies.back()->setFriction(0);
  cube.cube->body().m_cfg.kDF = 0;
  cube.cube->body().translate(btVector3(0, btScalar(kMargin - kHeight), 0));
  cube.cube->body().setVelocity(btVector3(3, 0, 0));
  for (int k = 0; k < 5; ++k) cube.frame();
  for (int k = 0; k < 30; ++k) EXPECT_EQ(cube.frame(), 4) << k;
}

/// Its box is in that of the ground.
TEST(ImpactParts, AreNotTakenByWhatRestsOnATiltedBox) {
  FallingCube cube;
  const btQuaternion turned(btVector3(0, 0, 1), btScalar(0.2));
  btRigidBody& ground = cube.rigids.add(cube.rigids.shape<btBoxShape>(btVector3(2, 2, 2)), 0, {0, 0, 0});
  ground.setWorldTransform(placeAt({0, 0, 0}, turned));
  cube.world.updateSingleAabb(&ground);
  ground.setFriction(5);
  cube.cube->body().m_cfg.kDF = 1;
  btSoftBody& body = cube.cube->body();
  body.translate(btVector3(0, btScalar(-kHeight - kSide / 2), 0));
  body.transform(placeAt({0, 0, 0}, turned));
  body.translate(quatRotate(turned, btVector3(0, btScalar(2 + kMargin + kSide / 2), 0)));
  body.setActivationState(DISABLE_DEACTIVATION);
  for (int k = 0; k < 20; ++k) cube.frame();
  for (int k = 0; k < 30; ++k) EXPECT_EQ(cube.frame(), 4) << k;
}

TEST(ImpactParts, AreTakenByTheBodysOwnGravity) {
  FallingCube falls, hangs;
  falls.world.setGravity(btVector3(0, 0, 0));
  for (FallingCube* cube : {&falls, &hangs}) cube->addFloor();
  ASSERT_TRUE(falls.cube->setGravity(btVector3(0, -10, 0)).ok());
  ASSERT_TRUE(hangs.cube->setGravity(btVector3(0, 0, 0)).ok());
  EXPECT_GE(falls.dividedFrames(), 1);
  EXPECT_EQ(hangs.dividedFrames(), 0);
}

TEST(ImpactParts, ACallOfNoTimeMakesNoStep) {
  FallingCube cube;
  cube.addFloor();
  for (int k = 0; k < 60; ++k) {
    EXPECT_EQ(cube.world.stepSimulation(0, 4, btScalar(1) / 240), 0);
    cube.frame();
  }
}

TEST(ImpactParts, AreTakenForObstaclesOfAnyKind) {
  const auto dividedBy = [](const auto& add) {
    FallingCube cube;
    add(cube);
    return cube.dividedFrames();
  };
  const btVector3 half(1, btScalar(0.5), 1);
  const auto box = [&](FallingCube& cube) {
    cube.rigids.add(cube.rigids.shape<btBoxShape>(half), 0, {0, -half.y(), 0});
  };
  const auto compound = [&](FallingCube& cube) {
    auto& parts = cube.rigids.shape<btCompoundShape>();
    parts.addChildShape(placeAt({0, -half.y(), 0}), &cube.rigids.shape<btBoxShape>(half));
    parts.addChildShape(placeAt({9, 9, 0}), &cube.rigids.shape<btBoxShape>(half));  // its box surrounds the cube
    cube.rigids.add(parts, 0, {0, 0, 0});
  };
  btTriangleMesh triangles;
  triangles.addTriangle({-5, -1, -5}, {0, -1, 5}, {5, -1, -5});
  const auto mesh = [&](FallingCube& cube) {
    cube.rigids.add(cube.rigids.shape<btBvhTriangleMeshShape>(&triangles, true), 0, {0, 1, 0});
  };
  const auto rising = [&](FallingCube& cube) {
    btRigidBody& body = cube.rigids.add(cube.rigids.shape<btBoxShape>(half), 100, {0, -3, 0});
    body.setGravity(btVector3(0, 0, 0));
    body.setLinearVelocity(btVector3(0, 5, 0));
  };
  EXPECT_GE(dividedBy(box), 1);
  EXPECT_LE(dividedBy(box), 2);
  EXPECT_GE(dividedBy(compound), 1);
  EXPECT_LE(dividedBy(compound), 2);
  EXPECT_GE(dividedBy(mesh), 1);
  EXPECT_LE(dividedBy(mesh), 2);
  EXPECT_GE(dividedBy(rising), 1);
  const auto driven = [&](FallingCube& cube) {
    btRigidBody& body = cube.rigids.add(cube.rigids.shape<btBoxShape>(half), 0, {0, -half.y(), 0});
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  };
  EXPECT_GE(dividedBy(driven), 1);
  std::unique_ptr<DeformableBody> below;
  const auto soft = [&](FallingCube& cube) {
    below = DeformableBody::add(cube.world, latticeCage(4, 4, 4, kSide / 4)).value();
    below->body().m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
    cube.cube->body().m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
    ASSERT_TRUE(below->setGravity(btVector3(0, 0, 0)).ok());
  };
  EXPECT_GE(dividedBy(soft), 1);
  below.reset();
  EXPECT_EQ(dividedBy([](FallingCube& cube) {  // a slope that it flies along
              cube.cube->body().setVelocity(btVector3(2, 0, 0));
              cube.world.setGravity(btVector3(0, 0, 0));
              cube.rigids.add(cube.rigids.shape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(-0.3)), 0, {0, 0, 0});
            }),
            0);
}

class ReplayedCube : public ReplayedScene {
 public:
  ReplayedCube() { cube_.addFloor(); }
  btDeformableMultiBodyDynamicsWorld& world() override { return cube_.world; }
  void frame(int) override { steps = cube_.frame(); }

  int steps = 0;

 private:
  FallingCube cube_;
};

TEST(ImpactParts, SnapshotsBeforeAndWithinThemAreExact) {
  ReplayedCube scene;
  std::vector<int> around;
  for (int f = 0; f < 90; ++f) {
    scene.frame(f);
    if (scene.steps <= 4) continue;
    for (const int by : {-2, -1, 0}) around.push_back(f + by);
  }
  ASSERT_GT(around.size(), 2U);
  expectReplays([] { return std::make_unique<ReplayedCube>(); }, 90, around, 12);
}

}  // namespace
}  // namespace tetskin::test
