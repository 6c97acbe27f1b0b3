// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

TEST(SurfaceWelds, KeepAHangingBodyAtItsPlace) {
  for (const double mass : {0.01, 0.1, 1.0, 10.0}) {
    auto world = deformableWorld(10);
    SoftBodyOptions held;
    held.pinned = [](const Vector3d& rest) { return rest.y() > 3.7; };
    TouchedBody body(*world, TouchModel(0.38, 3.0), held);
    const SurfacePoint point = body.vertex(body.furthest(-Vector3d::UnitY()));
    RigidBox box(*world, mass, *point.position() + btVector3(btScalar(0.05), btScalar(-0.15), 0));
    box->setActivationState(DISABLE_DEACTIVATION);
    auto weld = SurfaceWeld::add(world->deformable(), point, *box).value();
    double worst = 0, turned = 0, mean = 0;
    for (int s = 0; s < 1440; ++s) {
      substep(*world);
      if (s >= 960) mean += static_cast<double>(weld->force().y()) / 480;
      worst = std::max(worst, static_cast<double>(weld->separation()));
      turned = std::max(turned, static_cast<double>(weld->angle()));
    }
    EXPECT_LT(worst, 1e-4) << mass;
    EXPECT_LT(turned, 0.02) << mass;
    EXPECT_NEAR(mean, -10 * mass, 0.3 * mass) << mass;
    EXPECT_TRUE(isFinite(body.body()));
  }
}

TEST(SurfaceWelds, FollowABodyThatIsSwung) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint top = body.vertex(body.furthest(Vector3d::UnitY())),
                     low = body.vertex(body.furthest(-Vector3d::UnitY()));
  RigidBox box(*world, 0.2, *low.position() - btVector3(0, btScalar(0.2), 0),
               btVector3(btScalar(0.02), btScalar(0.2), btScalar(0.02)));
  box->setActivationState(DISABLE_DEACTIVATION);
  auto weld = SurfaceWeld::add(world->deformable(), low, *box).value();
  auto spring = SurfaceSpring::add(world->deformable(), top).value();
  const btVector3 start = *top.position();
  double worst = 0;
  for (int s = 0; s < 720; ++s) {
    const double angle = 2 * EIGEN_PI * s / 240;
    ASSERT_EQ(spring->setTarget(start + toBullet({0.3 * std::sin(angle), 0, 0.3 - 0.3 * std::cos(angle)})),
              StatusCode::Ok);
    substep(*world);
    worst = std::max(worst, static_cast<double>(weld->separation()));
  }
  EXPECT_LT(worst, 1e-4);
  EXPECT_TRUE(isFinite(body.body()));
}

TEST(SurfaceWelds, TurnTheBodyWithWhatIsFixedToIt) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitX()));
  RigidBox box(*world, 1.0, *point.position() + btVector3(btScalar(0.1), 0, 0));
  box->setActivationState(DISABLE_DEACTIVATION);
  auto weld = SurfaceWeld::add(world->deformable(), point, *box).value();
  box->setAngularVelocity(btVector3(2, 0, 0));
  for (int s = 0; s < 120; ++s) substep(*world);
  const Vector3d centre = [&] {
    Vector3d sum = Vector3d::Zero();
    for (int n = 0; n < body.body().m_nodes.size(); ++n) sum += toEigen(body.body().m_nodes[n].m_x);
    return Vector3d(sum / body.body().m_nodes.size());
  }();
  const Momentum now(body.body());
  EXPECT_GT((now.angular - centre.cross(now.linear)).x(), 1e-3);
  EXPECT_LT(box->getAngularVelocity().x(), 1.9);
  EXPECT_LT(weld->separation(), 1e-4);
}

TEST(SurfaceWelds, FixAPointToWhatCannotMove) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitY()));
  RigidBox wall(*world, 0, *point.position() + btVector3(0, btScalar(0.2), 0));
  auto weld = SurfaceWeld::add(world->deformable(), point, *wall).value();
  const btVector3 start = *point.position();
  double worst = 0;
  for (int s = 0; s < 480; ++s) {
    substep(*world);
    worst = std::max(worst, static_cast<double>((*point.position() - start).length()));
  }
  EXPECT_LT(worst, 2e-4);
  EXPECT_TRUE(isFinite(body.body()));
}

TEST(SurfaceWelds, MoveTheLinkOfAMultibody) {
  auto world = deformableWorld(10);
  SoftBodyOptions held;
  held.pinned = [](const Vector3d& rest) { return rest.y() > 3.7; };
  TouchedBody body(*world, TouchModel(0.38, 3.0), held);
  const SurfacePoint point = body.vertex(body.furthest(-Vector3d::UnitY()));
  const btVector3 at = *point.position() - btVector3(0, btScalar(0.1), 0);
  // A free base and a link on a hinge, half a unit to one side.
  btBoxShape shape(btVector3(btScalar(0.05), btScalar(0.05), btScalar(0.05)));
  btVector3 inertia(0, 0, 0);
  shape.calculateLocalInertia(btScalar(0.3), inertia);
  btMultiBody arm(1, btScalar(0.3), inertia, false, false);
  arm.setBasePos(at);
  arm.setupRevolute(0, btScalar(0.2), inertia, -1, btQuaternion(0, 0, 0, 1), btVector3(0, 0, 1),
                    btVector3(btScalar(0.25), 0, 0), btVector3(btScalar(0.25), 0, 0), true);
  arm.finalizeMultiDof();
  arm.setCanSleep(false);
  world->deformable().addMultiBody(&arm);
  btMultiBodyLinkCollider base(&arm, -1), link(&arm, 0);
  base.setCollisionShape(&shape);
  link.setCollisionShape(&shape);
  arm.setBaseCollider(&base);
  arm.getLink(0).m_collider = &link;
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> origins;
  arm.forwardKinematics(turns, origins);
  arm.updateCollisionObjectWorldTransforms(turns, origins);
  world->deformable().addCollisionObject(&base, 2, 0);
  world->deformable().addCollisionObject(&link, 2, 0);
  {
    auto weld = SurfaceWeld::add(world->deformable(), point, base).value();
    double worst = 0;
    for (int s = 0; s < 960; ++s) {
      substep(*world);
      worst = std::max(worst, static_cast<double>(weld->separation()));
    }
    EXPECT_LT(worst, 2e-4);
    EXPECT_NEAR(static_cast<double>(weld->force().y()), -5, 0.6);  // the weight of both bodies
    EXPECT_TRUE(isFinite(body.body()));
  }
  world->deformable().removeCollisionObject(&link);
  world->deformable().removeCollisionObject(&base);
  world->deformable().removeMultiBody(&arm);
}

}  // namespace
}  // namespace tetskin::test
