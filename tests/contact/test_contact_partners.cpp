// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a body may touch, beside what stands still.
#include "contact_test.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace tetskin::test {
namespace {

class ContactPartners : public testing::TestWithParam<Setting> {
 protected:
  static SoftBodyOptions material() {
    SoftBodyOptions options;
    options.implicit = GetParam() == Setting::Implicit;
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(EachSetting, ContactPartners,
                         testing::Values(Setting::Explicit, Setting::Implicit, Setting::OwnSolver), settingName);

TEST_P(ContactPartners, ALinkOfAMultiBodyIsPushed) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  world.deformable().setGravity(btVector3(0, 0, 0));
  btMultiBody multi(0, 1, btVector3(1, 1, 1), false, false);
  multi.setBaseWorldTransform(placeAt(btVector3(0, 3, 0)));
  multi.finalizeMultiDof();
  btBoxShape shape(btVector3(1, btScalar(0.2), 1));
  btVector3 inertia;
  shape.calculateLocalInertia(1, inertia);
  multi.setBaseInertia(inertia);
  btMultiBodyLinkCollider link(&multi, -1);
  link.setCollisionShape(&shape);
  link.setWorldTransform(placeAt(btVector3(0, 3, 0)));
  link.setInterpolationWorldTransform(link.getWorldTransform());
  link.setFriction(1);
  multi.setBaseCollider(&link);
  world.deformable().addMultiBody(&multi);
  world.deformable().addCollisionObject(&link);
  {
    TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(3.7), 0), {}, material());
    btSoftBody& soft = body.body->body();
    soft.setVelocity(btVector3(0, -2, 0));
    for (int n = 0; n < soft.m_nodes.size(); ++n)
      soft.m_nodes[n].m_vn = soft.m_nodes[n].m_v;  // implicit steps begin so
    bool touched = false;
    for (int f = 0; f < 30; ++f) {
      step(world, 1);
      for (const SurfaceContactPoint& at : body.contact->contacts()) touched = touched || at.object == &link;
    }
    EXPECT_TRUE(touched);
    EXPECT_LT(multi.getBaseVel().y(), -0.3);
    EXPECT_GT(body.height(), link.getWorldTransform().getOrigin().y() + 0.2 - 0.01);
  }
  world.deformable().removeCollisionObject(&link);
  world.deformable().removeMultiBody(&multi);
}

TEST_P(ContactPartners, AKinematicBodyCarriesWhatLiesOnIt) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  Obstacle lift(world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.2), 1)), placeAt(btVector3(0, 1, 0)));
  lift.body().setCollisionFlags(lift.body().getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.body().setActivationState(DISABLE_DEACTIVATION);
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(1.56), 0), {}, material());
  double lowestGap = HUGE_VAL;
  for (int k = 0; k < 480; ++k) {
    const btScalar y = 1 + btScalar(0.5) * k / 240;
    lift.body().setWorldTransform(placeAt(btVector3(0, y, 0)));
    world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    if (k % 8 == 0) lowestGap = std::min(lowestGap, body.height() - (static_cast<double>(y) + 0.2));
  }
  EXPECT_GT(lowestGap, -0.01);
  EXPECT_NEAR(body.height(), 2.2, 0.01);
}

TEST_P(ContactPartners, AFallingBallWakesASleeper) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.36), 0), {}, material());
  btSoftBody& soft = body.body->body();
  const btScalar threshold = soft.m_sleepingThreshold;
  for (int f = 0; f < 400 && soft.isActive(); ++f) {
    if (f == 120) soft.m_sleepingThreshold = 1;  // nobody waits for the last of its rocking
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
