// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// A motion of one turn per second on a circle with a radius of a quarter of a unit.
btVector3 onCircle(const btVector3& start, double seconds) {
  const double angle = 2 * EIGEN_PI * seconds;
  return start + toBullet({0.25 * std::sin(angle), 0.25 * (1 - std::cos(angle)), 0});
}

/// The largest distance between point and target during two seconds of swinging, not counting the first half second.
double worstLag(EmptyWorld& world, const SurfacePoint& point, SurfaceSpring& spring, double dt) {
  const btVector3 start = *point.position();
  double worst = 0;
  for (double t = 0; t < 2; t += dt) {
    const btVector3 target = onCircle(start, t);
    EXPECT_EQ(spring.setTarget(target), StatusCode::Ok);
    substep(world, dt);
    if (t > 0.5) worst = std::max(worst, static_cast<double>((*point.position() - target).length()));
  }
  return worst;
}

TEST(SurfaceSprings, KeepAPointNearItsTarget) {
  for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
    auto world = deformableWorld(10);
    TouchedBody body(*world, TouchModel(0.38, 3.0));
    const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitY()));
    auto spring = SurfaceSpring::add(world->deformable(), point).value();
    EXPECT_LT(worstLag(*world, point, *spring, dt), 0.02) << dt;
    EXPECT_TRUE(isFinite(body.body())) << dt;
  }
}

TEST(SurfaceSprings, AreStableAtAnyStiffness) {
  for (const double radius : {0.38, 0.55}) {
    for (const double stiffness : {1e-3, 1.0, 1e3, 1e6}) {
      for (const double dt : {1.0 / 60, 1.0 / 1000}) {
        auto world = deformableWorld(10);
        TouchedBody body(*world, TouchModel(radius, 3.0));
        const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitX()));
        SurfaceSpringOptions options;
        options.stiffness = stiffness;
        options.maxForce = INFINITY;  // the target moves faster than the default force can follow
        auto spring = SurfaceSpring::add(world->deformable(), point, options).value();
        const double lag = worstLag(*world, point, *spring, dt);
        EXPECT_TRUE(isFinite(body.body())) << stiffness << " " << dt << " " << radius;
        // Outside the cage, the point's tet bends away from under it: a spring of any stiffness is one step behind
        // that.
        if (stiffness == 1e3 || (stiffness > 1e3 && radius < 0.4)) {
          EXPECT_LT(lag, radius < 0.4 ? 0.001 : 0.03) << stiffness << " " << dt << " " << radius;
        }
      }
    }
  }
}

TEST(SurfaceSprings, CarryTheBodysWeight) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitY()));
  auto spring = SurfaceSpring::add(world->deformable(), point).value();
  Vector3d mean = Vector3d::Zero();
  for (int s = 0; s < 1440; ++s) {
    substep(*world);
    if (s >= 960) mean += toEigen(spring->force()) / 480;
  }
  EXPECT_LT((mean - Vector3d(0, 10, 0)).norm(), 0.2);
}

TEST(SurfaceSprings, NeverPullHarderThanAllowed) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitY()));
  SurfaceSpringOptions options;
  options.stiffness = 1000;
  options.maxForce = 14;
  auto spring = SurfaceSpring::add(world->deformable(), point, options).value();
  const btVector3 start = *point.position();
  ASSERT_EQ(spring->setTarget(start + btVector3(0, 1, 0)), StatusCode::Ok);
  double maximum = 0;
  for (int s = 0; s < 1500; ++s) {
    substep(*world);
    maximum = std::max(maximum, static_cast<double>(spring->force().length()));
  }
  EXPECT_LE(maximum, 14 * 1.05);
  EXPECT_GT(maximum, 13);
  // More force than its weight: it reaches the target.
  EXPECT_LT((*point.position() - start - btVector3(0, 1, 0)).length(), 0.02);
  ASSERT_EQ(spring->setMaxForce(6), StatusCode::Ok);
  for (int s = 0; s < 200; ++s) substep(*world);
  EXPECT_LT(point.position()->y(), start.y());  // less force than its weight: it sinks
  EXPECT_TRUE(isFinite(body.body()));
}

TEST(SurfaceSprings, HangABodyOnARigidOneThatFeelsIt) {
  for (const double mass : {0.1, 1.0, 10.0}) {
    auto world = deformableWorld(10);
    SoftBodyOptions held;
    held.pinned = [](const Vector3d& rest) { return rest.y() > 3.7; };
    TouchedBody body(*world, TouchModel(0.38, 3.0), held);
    const SurfacePoint point = body.vertex(body.furthest(-Vector3d::UnitY()));
    const btVector3 pivot(0, btScalar(0.1), 0);
    RigidBox box(*world, mass, *point.position() - pivot);
    box->setActivationState(DISABLE_DEACTIVATION);
    auto spring = SurfaceSpring::add(world->deformable(), point, *box, pivot).value();
    double worst = 0, mean = 0;
    for (int s = 0; s < 1440; ++s) {
      substep(*world);
      worst = std::max(worst, static_cast<double>(spring->stretch()));
      if (s >= 960) mean += static_cast<double>(spring->force().y()) / 480;
    }
    EXPECT_LT(worst, 0.001) << mass;
    EXPECT_NEAR(mean, -10 * mass, 0.3 * mass) << mass;
  }
}

TEST(SurfaceSprings, ExchangeMomentumWithARigidBody) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitX()));
  RigidBox box(*world, 0.5, *point.position() + btVector3(btScalar(0.15), 0, 0));
  box->setActivationState(DISABLE_DEACTIVATION);
  auto spring = SurfaceSpring::add(world->deformable(), point, *box, btVector3(btScalar(-0.15), 0, 0)).value();
  box->setLinearVelocity(btVector3(0, 1, 0));
  for (int s = 0; s < 240; ++s) substep(*world);
  const Vector3d sum = Momentum(body.body()).linear + 0.5 * toEigen(box->getLinearVelocity());
  EXPECT_LT((sum - Vector3d(0, 0.5, 0)).norm(), 0.01);
  EXPECT_GT(Momentum(body.body()).linear.y(), 0.1);
}

TEST(SurfaceSprings, HoldARigidBodyByManyPointsAtOnce) {
  auto world = deformableWorld(10);
  SoftBodyOptions held;
  held.pinned = [](const Vector3d& rest) { return rest.y() > 3.7; };
  TouchedBody body(*world, TouchModel(0.38, 3.0), held);
  RigidBox box(*world, 0.3, btVector3(btScalar(0.5), btScalar(2.9), btScalar(0.5)));
  box->setActivationState(DISABLE_DEACTIVATION);
  std::vector<std::unique_ptr<SurfaceSpring>> springs;
  for (int v = 0; v < 12; ++v) {
    const SurfacePoint point = body.vertex(v * 17);
    const btVector3 pivot = box->getWorldTransform().invXform(*point.position());
    springs.push_back(SurfaceSpring::add(world->deformable(), point, *box, pivot).value());
  }
  for (int s = 0; s < 480; ++s) substep(*world);
  EXPECT_LT(box->getLinearVelocity().length(), 0.05);
  for (const auto& spring : springs) EXPECT_LT(spring->stretch(), 0.01);
}

/// Unbounded springs threw the body at hundreds of body lengths per second, and stretched it to twenty body lengths.
TEST(SurfaceSprings, WhoseTargetJumpsNeitherThrowNorTearTheBodyByDefault) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const SurfacePoint point = body.vertex(body.furthest(Vector3d::UnitX()));
  auto spring = SurfaceSpring::add(world->deformable(), point).value();
  const btVector3 target = *point.position() + btVector3(5, 2, 0);
  ASSERT_EQ(spring->setTarget(target), StatusCode::Ok);
  double fastest = 0, largest = 0;
  for (int s = 0; s < 480; ++s) {
    substep(*world);
    ASSERT_TRUE(isFinite(body.body()));
    fastest = std::max(fastest, fastestOf(body.body()));
    btVector3 low, high;
    body.body().updateBounds();
    body.body().getAabb(low, high);
    largest = std::max(largest, static_cast<double>((high - low).length()));
  }
  EXPECT_LT(fastest, 40);
  EXPECT_LT(largest, 6);
  EXPECT_LT((*point.position() - target).length(), 3) << "it comes";
}

TEST(SurfaceSpring, RefusesWhatMakesNoSense) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  const SurfacePoint point = body.vertex(0);
  const auto codeOf = [&](double stiffness, double damping, double maxForce) {
    SurfaceSpringOptions options;
    options.stiffness = stiffness;
    options.dampingRatio = damping;
    options.maxForce = maxForce;
    return SurfaceSpring::add(world->deformable(), point, options).status().code;
  };
  EXPECT_EQ(codeOf(10, 1, 5), StatusCode::Ok);
  EXPECT_EQ(codeOf(-1, 0, 5), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(INFINITY, 0, 5), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(10, -1, 5), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(10, NAN, 5), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(0, 0, 5), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(10, 0, 0), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(10, 0, INFINITY), StatusCode::Ok);
  EXPECT_EQ(codeOf(10, 0, -1), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(10, 0, NAN), StatusCode::InvalidOption);
  EXPECT_EQ(SurfaceSpring::add(world->deformable(), {}).status().code, StatusCode::InvalidOption);
  auto other = deformableWorld();
  EXPECT_EQ(SurfaceSpring::add(other->deformable(), point).status().code, StatusCode::InvalidOption);
  auto spring = SurfaceSpring::add(world->deformable(), point).value();
  EXPECT_EQ(spring->setTarget(btVector3(NAN, 0, 0)), StatusCode::NonFinite);
  EXPECT_EQ(spring->setStiffness(0), StatusCode::InvalidOption);
  EXPECT_EQ(spring->setMaxForce(-1), StatusCode::InvalidOption);
  EXPECT_EQ(spring->setStiffness(100), StatusCode::Ok);
}

TEST(SurfaceSpring, LeavesCollisionsAsTheyWere) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  RigidBox box(*world, 1, btVector3(3, 3, 3));
  const auto& hidden = body.body().m_collisionDisabledObjects;
  // Either of the two may be destroyed first.
  for (const bool firstGoesFirst : {true, false}) {
    auto spring = SurfaceSpring::add(world->deformable(), body.vertex(0), *box, btVector3(0, 0, 0)).value();
    EXPECT_GT(hidden.size(), 0);
    auto second = SurfaceSpring::add(world->deformable(), body.vertex(9), *box, btVector3(0, 0, 0)).value();
    (firstGoesFirst ? spring : second).reset();
    EXPECT_GT(hidden.size(), 0);
    (firstGoesFirst ? second : spring).reset();
    EXPECT_EQ(hidden.size(), 0);
  }
  SurfaceSpringOptions both;
  both.collideConnected = true;
  const auto spring = SurfaceSpring::add(world->deformable(), body.vertex(0), *box, btVector3(0, 0, 0), both).value();
  EXPECT_EQ(hidden.size(), 0);
}

TEST(SurfaceSpring, WakesABodyThatHangsOnWhatIsMoved) {
  auto world = deformableWorld();
  world->deformable().setGravity(btVector3(0, 0, 0));
  TouchedBody body(*world);
  RigidBox platform(*world, 0, btVector3(0, 3, 0));
  (*platform).setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  const auto spring = SurfaceSpring::add(world->deformable(), body.vertex(0), *platform, btVector3(0, 0, 0)).value();
  step(*world, 1);
  body.body().forceActivationState(ISLAND_SLEEPING);
  step(*world, 2);
  EXPECT_FALSE(body.body().isActive());
  btTransform moved = (*platform).getWorldTransform();
  moved.getOrigin() += btVector3(0, btScalar(0.1), 0);
  (*platform).setWorldTransform(moved);
  step(*world, 2);
  EXPECT_TRUE(body.body().isActive());
  const auto led = SurfaceSpring::add(world->deformable(), body.vertex(0)).value();
  body.body().forceActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(led->setTarget(btVector3(0, 9, 0)), StatusCode::Ok);
  EXPECT_TRUE(body.body().isActive());
}

TEST(SurfaceSpring, WakesTheBodyThatItHasHeldWhenItIsReleased) {
  for (const bool deleted : {false, true}) {
    auto world = deformableWorld(10);
    TouchedBody body(*world, TouchModel(0.38, 3.0));
    auto spring = SurfaceSpring::add(world->deformable(), body.vertex(body.furthest(Vector3d::UnitY()))).value();
    body.body().forceActivationState(ISLAND_SLEEPING);
    deleted ? spring.reset() : spring->release();
    EXPECT_TRUE(body.body().isActive());
  }
}

TEST(SurfaceSpring, KeepsABodyAwakeThatHangsOnWhatMovesSlowly) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  body.body().forceActivationState(ACTIVE_TAG);
  RigidBox hook(*world, 0, btVector3(0, 3, 0));
  hook->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  hook->setActivationState(DISABLE_DEACTIVATION);
  const auto spring = SurfaceSpring::add(world->deformable(), body.vertex(0), *hook, btVector3(0, 0, 0)).value();
  for (int k = 0; k < 720; ++k) {
    btTransform position = hook->getWorldTransform();
    position.getOrigin() += btVector3(0, btScalar(0.01) / 240, 0);
    hook->setWorldTransform(position);
    substep(*world);
    ASSERT_TRUE(body.body().isActive()) << "step " << k;
  }
}

TEST(SurfaceSpring, RefusesPivotsThatAreNoPlaces) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  RigidBox box(*world, 1, btVector3(3, 3, 3));
  const btVector3 bad(0, std::numeric_limits<btScalar>::quiet_NaN(), 0);
  EXPECT_EQ(SurfaceSpring::add(world->deformable(), body.vertex(0), *box, bad).status().code, StatusCode::NonFinite);
}

}  // namespace
}  // namespace tetskin::test
