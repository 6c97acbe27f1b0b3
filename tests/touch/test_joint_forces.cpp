// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The effects of springs, welds and impulses on both sides, as ForceRecord reports them.
#include "solver/recorded_forces.h"
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Expects the only forces to be those of springs and welds.
void expectJointsAlone(const AppliedForces& forces) {
  EXPECT_FALSE(forces.joints.force.isZero());
  EXPECT_TRUE(isNothing({forces.contact, forces.friction, {}, forces.anchors}));
}

TEST(JointForces, OfASpringAreWhatHangsOnIt) {
  auto world = deformableWorld(kWeight);
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint top = body.vertex(body.furthest(Vector3d::UnitY()));
  RigidBox hook(*world, 0, *top.position() + btVector3(btScalar(0.3), btScalar(0.2), 0));
  auto spring = SurfaceSpring::add(world->deformable(), top, *hook, btVector3(btScalar(-0.3), btScalar(-0.2), 0));
  ASSERT_TRUE(spring.ok()) << spring.status().message;
  const auto forces = forcesIn(*world);
  step(*world, 900);
  const AppliedForces onHook = forces->forcesOn(*hook), onBody = forces->forcesOn(body.body());
  expectJointsAlone(onHook);
  expectJointsAlone(onBody);
  expectNear(onHook.joints.force, btVector3(0, -kWeight, 0), 0.01 * kWeight);
  expectNear(onHook.joints.torque, btVector3(btScalar(-0.3), btScalar(-0.2), 0).cross(onHook.joints.force), 1e-3);
  expectNear(onBody.joints.force, -onHook.joints.force, 1e-5);
  expectNear(onBody.joints.force, spring.value()->force(), 0.01 * kWeight);
  spring.value().reset();
  step(*world, 1);
  EXPECT_TRUE(isNothing(forces->forcesOn(*hook)));
}

/// At rest, the torque of the weld's force, which acts beside the centre of mass, and the weld's couple balance.
TEST(JointForces, OfAWeldHoldABodyAndItsTurn) {
  auto world = deformableWorld(kWeight);
  SoftBodyOptions held;
  held.pinned = [](const Vector3d& rest) { return rest.y() > 3.7; };
  TouchedBody body(*world, TouchModel(0.38, 3.0), held);
  const SurfacePoint low = body.vertex(body.furthest(-Vector3d::UnitY()));
  RigidBox box(*world, 0.5, *low.position() + btVector3(btScalar(0.05), btScalar(-0.15), 0));
  box->setActivationState(DISABLE_DEACTIVATION);
  auto weld = SurfaceWeld::add(world->deformable(), low, *box);
  ASSERT_TRUE(weld.ok()) << weld.status().message;
  const auto forces = forcesIn(*world);
  step(*world, 900);
  const AppliedForces onBox = forces->forcesOn(*box);
  expectJointsAlone(onBox);
  expectNear(onBox.joints.force, btVector3(0, btScalar(0.5 * kWeight), 0), 0.01 * kWeight);
  expectNear(onBox.joints.torque, btVector3(0, 0, 0), 0.01 * kWeight * 0.05);
  const btVector3 arm = *low.position() - (*box).getWorldTransform().getOrigin();
  expectNear(weld.value()->torque(), arm.cross(onBox.joints.force), 0.02 * kWeight * 0.05);
}

/// A body hangs on a hook by a spring, and a box on the body by a weld.
TEST(JointForces, StayAsTheyAreWhenAllFallAsleep) {
  auto world = deformableWorld(kWeight);
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint top = body.vertex(body.furthest(Vector3d::UnitY()));
  const SurfacePoint low = body.vertex(body.furthest(-Vector3d::UnitY()));
  RigidBox hook(*world, 0, *top.position());
  RigidBox box(*world, 0.5, *low.position() + btVector3(0, btScalar(-0.1), 0));
  body.body().forceActivationState(ACTIVE_TAG);
  const auto spring = SurfaceSpring::add(world->deformable(), top, *hook, btVector3(0, 0, 0)).value();
  const auto weld = SurfaceWeld::add(world->deformable(), low, *box).value();
  btVector3 pull(0, 0, 0), hold(0, 0, 0);
  for (int f = 0; f < 1800 && body.body().isActive(); ++f) {
    if (f == 600) body.body().m_sleepingThreshold = 1;
    pull = spring->force();
    hold = weld->force();
    step(*world, 1);
  }
  ASSERT_FALSE(body.body().isActive());
  ASSERT_FALSE(box->isActive()) << "in the same step";
  step(*world, 20);
  EXPECT_NEAR(pull.y(), 1.5 * kWeight, 0.03 * kWeight);
  expectNear(spring->force(), pull, 0.03 * kWeight);
  expectNear(weld->force(), hold, 0.03 * kWeight);
}

TEST(JointForces, OfAPushAreOnTheBodyAlone) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const auto forces = forcesIn(*world);
  SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitX()));
  ASSERT_EQ(point.applyForce(btVector3(0, 0, 24)), StatusCode::Ok);
  substep(*world);
  expectJointsAlone(forces->forcesOn(body.body()));
  expectNear(forces->forcesOn(body.body()).joints.force, btVector3(0, 0, 24), 1e-3);
  substep(*world);
  EXPECT_TRUE(isNothing(forces->forcesOn(body.body())));
}

}  // namespace
}  // namespace tetskin::test
