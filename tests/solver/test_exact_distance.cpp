// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/points_within.h"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/solver/src/base/exact_distance.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

/// The distance is how far the point must be moved against the normal to lie on the surface.
void expectSurfaceAtDistance(const btCollisionShape& shape) {
  for (const btVector3& point : pointsWithin(2, 500)) {
    const ShapeDistance at = ExactShape::exactShape(shape)->distance(point);
    EXPECT_NEAR(at.normal.length(), 1, 1e-5);
    EXPECT_NEAR(ExactShape::exactShape(shape)->distance(point - at.distance * at.normal).distance, 0, 1e-5);
  }
}

/// Compares with Bullet's own distance, which rounds edges and corners by the margin.
void expectBulletsDistance(const btConvexShape& shape) {
  for (const btVector3& point : pointsWithin(2, 300)) {
    const ShapeDistance at = ExactShape::exactShape(shape)->distance(point);
    if (at.distance < btScalar(0.01)) continue;
    btGjkEpaSolver2::sResults results;
    const btScalar bullets = btGjkEpaSolver2::SignedDistance(point, 0, &shape, btTransform::getIdentity(), results);
    EXPECT_NEAR(at.distance, bullets, 2e-3);
  }
}

TEST(ExactDistance, OfABoxIsBullets) {
  btBoxShape box(btVector3(1, btScalar(0.5), btScalar(0.75)));
  box.setMargin(btScalar(1e-3));
  expectSurfaceAtDistance(box);
  expectBulletsDistance(box);
}

TEST(ExactDistance, OverAFaceIsTheHeightAboveIt) {
  const btBoxShape box(btVector3(1, btScalar(0.1), btScalar(0.75)));  // as thin as the ball's radius, twice
  const btStaticPlaneShape plane(btVector3(0, 1, 0), btScalar(0.2));
  const btSphereShape sphere(1);
  const ExactShape exact = *ExactShape::exactShape(box);
  int over = 0, beside = 0;
  for (const btVector3& centre : pointsWithin(2, 300)) {
    EXPECT_TRUE(ExactShape::exactShape(plane)->isHalfSpace(centre, 1));
    EXPECT_FALSE(ExactShape::exactShape(sphere)->isHalfSpace(centre, btScalar(0.1)));
    const btScalar radius = btScalar(0.2);
    if (!exact.isHalfSpace(centre, radius)) {
      ++beside;
      continue;
    }
    ++over;
    const ShapeDistance at = exact.distance(centre);
    for (const btVector3& point : pointsWithin(1, 50)) {
      const btVector3 offset = point * (radius / std::max(point.length(), btScalar(1)));
      const ShapeDistance there = exact.distance(centre + offset);
      EXPECT_NEAR(there.distance, at.distance + at.normal.dot(offset), 1e-5);
      EXPECT_GT(there.normal.dot(at.normal), btScalar(0.9999));
    }
  }
  EXPECT_GT(over, 10);
  EXPECT_GT(beside, 10);
}

TEST(ExactDistance, OfASphereIsBullets) {
  const btSphereShape sphere(btScalar(0.8));
  expectSurfaceAtDistance(sphere);
  expectBulletsDistance(sphere);
}

TEST(ExactDistance, OfACapsuleAlongEachAxisIsBullets) {
  const btCapsuleShapeX x(btScalar(0.4), 1);
  const btCapsuleShape y(btScalar(0.4), 1);
  const btCapsuleShapeZ z(btScalar(0.4), 1);
  for (const btCapsuleShape* capsule :
       {static_cast<const btCapsuleShape*>(&x), &y, static_cast<const btCapsuleShape*>(&z)}) {
    expectSurfaceAtDistance(*capsule);
    expectBulletsDistance(*capsule);
  }
}

TEST(ExactDistance, OfACylinderAlongEachAxisIsBullets) {
  btCylinderShapeX x(btVector3(1, btScalar(0.4), btScalar(0.4)));
  btCylinderShape y(btVector3(btScalar(0.6), btScalar(0.3), btScalar(0.6)));
  btCylinderShapeZ z(btVector3(btScalar(0.5), btScalar(0.5), 1));
  for (btCylinderShape* cylinder : {static_cast<btCylinderShape*>(&x), &y, static_cast<btCylinderShape*>(&z)}) {
    cylinder->setMargin(btScalar(1e-3));
    expectSurfaceAtDistance(*cylinder);
    expectBulletsDistance(*cylinder);
  }
}

TEST(ExactDistance, OfAPlaneIsAlongItsNormal) {
  const btVector3 normal = btVector3(1, 2, 3).normalized();
  const btStaticPlaneShape plane(normal, btScalar(0.5));
  EXPECT_NEAR(ExactShape::exactShape(plane)->distance(3 * normal).distance, 2.5, 1e-6);
  EXPECT_NEAR(ExactShape::exactShape(plane)->distance(-normal).distance, -1.5, 1e-6);
  expectSurfaceAtDistance(plane);
}

TEST(ExactDistance, HasANormalAtCentresAndOnFacesEdgesAndCorners) {
  const btBoxShape box(btVector3(1, 1, 1));
  const btSphereShape sphere(1);
  const btCapsuleShape capsule(1, 1);
  for (const btCollisionShape* shape :
       {static_cast<const btCollisionShape*>(&box), static_cast<const btCollisionShape*>(&sphere),
        static_cast<const btCollisionShape*>(&capsule)}) {
    for (const btVector3& point : {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(1, 1, 0), btVector3(-1, 1, -1)}) {
      EXPECT_NEAR(ExactShape::exactShape(*shape)->distance(point).normal.length(), 1, 1e-5);
    }
  }
  EXPECT_EQ(ExactShape::exactShape(box)->distance(btVector3(1, 1, 1)).distance, 0);
}

TEST(ExactDistance, IsKnownForShapesWithFormulas) {
  const btCylinderShape oval(btVector3(1, 1, 2));
  EXPECT_FALSE(ExactShape::exactShape(oval));
  EXPECT_FALSE(ExactShape::exactShape(btConeShape(1, 1)));
  EXPECT_TRUE(ExactShape::exactShape(btSphereShape(1)));
}

}  // namespace
}  // namespace tetskin::test
