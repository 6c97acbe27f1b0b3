// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Objects that a body may touch, apart from static ones.
#include "contact_test.h"

namespace tetskin::test {
namespace {

TEST(ContactPartners, ALinkOfAMultiBodyIsPushed) {
  TetskinWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  FlatMultibody multi(world, 1, btVector3(0, 3, 0));
  multi.link.setFriction(1);
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(3.7), 0));
  body.body->body().setVelocity(btVector3(0, -2, 0));
  bool touched = false;
  for (int f = 0; f < 30; ++f) {
    step(world, 1);
    for (const SurfaceContactPoint& at : body.contact->contacts()) touched = touched || at.object == &multi.link;
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(multi.body.getBaseVel().y(), -0.3);
  EXPECT_GT(body.height(), multi.link.getWorldTransform().getOrigin().y() + 0.2 - 0.01);
}

/// Ways of moving a kinematic body in each step.
enum class Told { World, MotionState, Both };

/// How far a body is carried by a plate that moves 0.5 m sideways in one second and then 0.5 m up in another.
/// steps  the plate moves once per so many steps, which the world makes in one call
btVector3 carried(EmptyWorld& world, Told told, bool bySurface, int steps = 1) {
  const btVector3 start(0, 4, 0);
  btDefaultMotionState motion(placeAt(start));
  Obstacle plate(world, std::make_unique<btBoxShape>(btVector3(2, btScalar(0.5), 2)), placeAt(start));
  plate.body().setCollisionFlags(plate.body().getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  plate.body().setActivationState(DISABLE_DEACTIVATION);
  if (told == Told::MotionState) plate.body().setMotionState(&motion);
  TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.35, 0.35)),
                    btVector3(0, btScalar(bySurface ? 4.86 : 5.03), 0));
  if (!bySurface) body.contact.reset();
  btSoftBody& soft = body.body->body();
  soft.m_cfg.kDF = 1;
  const auto centre = [&] {
    btVector3 sum(0, 0, 0);
    for (int n = 0; n < soft.m_nodes.size(); ++n) sum += soft.m_nodes[n].m_x;
    return sum / static_cast<btScalar>(soft.m_nodes.size());
  };
  step(world, 15);
  const btVector3 before = centre();
  btVector3 at = start;
  for (int k = 0; k < 480; k += steps) {
    at += steps * btScalar(0.5) / 240 * (k < 240 ? btVector3(1, 0, 0) : btVector3(0, 1, 0));
    motion.setWorldTransform(placeAt(at));
    if (told != Told::MotionState) plate.body().setWorldTransform(placeAt(at));
    if (told == Told::Both) plate.body().setInterpolationWorldTransform(placeAt(at));
    world.deformable().stepSimulation(steps * btScalar(1) / 240, steps, btScalar(1) / 240);
  }
  plate.body().setMotionState(nullptr);
  return centre() - before;
}

/// Bullet moves the body to its new position in the first step of the frame, and derives its velocity from its previous
/// interpolation transform: if an application also sets that transform in each step, the velocity is zero, and only
/// sticking friction carries bodies that lie on it.
TEST(ContactPartners, AKinematicBodyCarriesHoweverAndHoweverOftenItIsMoved) {
  for (const int steps : {1, 2, 4, 8}) {
    for (const Told told : {Told::World, Told::MotionState, Told::Both}) {
      if (told == Told::Both && steps > 1) continue;
      for (const bool bySurface : {false, true}) {
        TetskinWorld world;
        const btVector3 direction = carried(world, told, bySurface, steps);
        EXPECT_NEAR(direction.x(), 0.5, 0.03) << bySurface << steps;
        EXPECT_NEAR(direction.y(), 0.5, 0.03) << bySurface << steps;
      }
    }
  }
}

/// The plate is put under the body from 20 m away, in one step: it counts as being at rest if both transforms are set.
TEST(ContactPartners, AKinematicBodyThatIsTeleportedByBothTransformsThrowsNothing) {
  TetskinWorld world;
  Obstacle plate(world, std::make_unique<btBoxShape>(btVector3(2, btScalar(0.5), 2)), placeAt(btVector3(0, -20, 0)));
  plate.body().setCollisionFlags(plate.body().getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  plate.body().setActivationState(DISABLE_DEACTIVATION);
  TouchingBody body(world, ballMesh(16, 0.35), btVector3(0, btScalar(4.9), 0));
  for (const auto tell : {&btCollisionObject::setWorldTransform, &btCollisionObject::setInterpolationWorldTransform}) {
    (plate.body().*tell)(placeAt(btVector3(0, 4, 0)));
  }
  step(world, 45);
  EXPECT_NEAR(body.height(), 4.5, 0.03);
}

TEST(ContactPartners, AFallingBallWakesASleeper) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.36), 0));
  btSoftBody& soft = body.body->body();
  const btScalar threshold = soft.m_sleepingThreshold;
  for (int f = 0; f < 400 && soft.isActive(); ++f) {
    if (f == 120) soft.m_sleepingThreshold = 1;  // so that the test need not wait for the last rocking motion to stop
    step(world, 1);
  }
  ASSERT_FALSE(soft.isActive());
  soft.m_sleepingThreshold = threshold;
  Obstacle ball(world, std::make_unique<btSphereShape>(btScalar(0.15)), placeAt(btVector3(0, btScalar(1.5), 0)),
                btScalar(0.2));
  step(world, 40);
  EXPECT_TRUE(soft.isActive());
  EXPECT_GT(ball.body().getWorldTransform().getOrigin().y(), 0.4);
}

}  // namespace
}  // namespace tetskin::test
