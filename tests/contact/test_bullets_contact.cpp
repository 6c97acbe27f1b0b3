// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How Bullet's own contact between soft and rigid bodies fails, as far as this can be reproduced with the installed
// version, and how SurfaceContact does it right. The table in tests/BULLET_DEFECTS.md names these tests.
#include "bullets_figure.h"
#include "contact_test.h"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <tetskin/solver/src/base/exact_distance.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

/// `SurfaceContact` uses the same algorithm for other convex shapes, but adds the margin; it treats hulls by their
/// faces and cylinders exactly.
btScalar gjkDistance(const btConvexShape& shape, const btVector3& point, btVector3* normal = nullptr) {
  btGjkEpaSolver2::sResults results;
  const btScalar distance = btGjkEpaSolver2::SignedDistance(point, 0, &shape, btTransform::getIdentity(), results);
  if (normal) *normal = results.normal;
  return distance;
}

double degreesBetween(const btVector3& a, const btVector3& b) {
  const auto cosine = static_cast<double>(a.dot(b));
  return std::acos(std::min(cosine, 1.0)) * 180.0 / EIGEN_PI;
}

/// The point is above the middle of a face, half a unit from the hull as drawn.
TEST(BulletsContact, FindsHullsAMarginLargerThanTheyAreDrawn) {
  btConvexHullShape hull;
  for (const Eigen::Vector3d& p : boxMesh(Eigen::Vector3d(1, 1, 1)).positions) hull.addPoint(toBullet(p));
  const btScalar distance = gjkDistance(hull, btVector3(0, btScalar(1.5), 0));
  figure("distance by GJK where it is 0.5", static_cast<double>(distance));
  EXPECT_NEAR(distance, btScalar(0.5) - hull.getMargin(), 1e-4);
  EXPECT_GT(hull.getMargin(), btScalar(0.03));
}

/// The largest error of a normal around a cylinder as high as it is wide, at distances of 0.02 to 0.5 of its radius.
double worstNormalAround(btScalar radius) {
  btCylinderShape cylinder(btVector3(radius, radius, radius));
  cylinder.setMargin(0);
  double worst = 0.0;
  for (const btVector3& p : pointsWithin(2 * radius, 2000)) {
    btVector3 nearest(p.x(), 0, p.z()), normal;
    nearest *= std::min(btScalar(1), radius / nearest.length());
    nearest.setY(std::max(-radius, std::min(radius, p.y())));
    const btScalar distance = (p - nearest).length() / radius;
    if (distance < btScalar(0.02) || distance > btScalar(0.5)) continue;
    (void)gjkDistance(cylinder, p, &normal);
    worst = std::max(worst, degreesBetween(normal, (p - nearest).normalized()));
  }
  return worst;
}

/// The accuracy of Bullet's algorithm is absolute; in double precision it is that for smaller shapes.
TEST(BulletsContact, HasNormalsThatAreOffAroundSmallShapes) {
  if (sizeof(btScalar) > sizeof(float)) GTEST_SKIP() << "of Bullet in float";
  const double large = worstNormalAround(1), small = worstNormalAround(btScalar(0.1)),
               tiny = worstNormalAround(btScalar(0.03));
  figure("degrees around a cylinder of radius 1", large);
  figure("degrees around a cylinder of radius 0.1", small);
  figure("degrees around a cylinder of radius 0.03", tiny);
  EXPECT_LT(large, 3.0);
  EXPECT_GT(small, 4.0);
  EXPECT_GT(tiny, 10.0);
}

/// The body's height half a second after it starts just above something whose upper side is at 3.5.
double heightOver(TetskinWorld& world, bool ours, const btVector3& at) {
  TouchingBody body(world, ballMesh(16, 0.35), at);
  if (!ours) body.contact.reset();
  step(world, 40);
  return body.height();
}

/// A body under Bullet's own force, for Bullet's solver.
std::unique_ptr<DeformableBody> bulletsBody(EmptyWorld& world, const btVector3& at) {
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  auto body = added(world, looseCage(), options);
  body->body().translate(at);
  return body;
}

TEST(BulletsContact, PlacesChildrenOfChildrenElsewhere) {
  const btQuaternion quarter(btVector3(0, 1, 0), SIMD_HALF_PI);
  for (const bool ours : {false, true}) {
    TetskinWorld world;
    btBoxShape box(btVector3(1, 1, 1) / 2);
    btCompoundShape inner;
    inner.addChildShape(placeAt(btVector3(2, 0, 0)), &box);
    auto outer = std::make_unique<btCompoundShape>();
    outer->addChildShape(placeAt(btVector3(0, 0, 0), quarter), &inner);  // turned so that the box is at -z
    const Obstacle obstacle(world, std::move(outer), placeAt(btVector3(0, 3, 0)));
    const double height = heightOver(world, ours, btVector3(0, btScalar(4.1), -2));
    EXPECT_EQ(std::abs(height - 3.5) < 0.01, ours) << height;
  }
}

/// The shelf gets the transform that is drawn, but not the one from which Bullet predicts motion.
TEST(BulletsContact, MissesBodiesThatWereOnlyToldOnceWhereTheyAre) {
  const auto addShelf = [](EmptyWorld& world) {
    auto shelf = std::make_unique<Obstacle>(world, std::make_unique<btBoxShape>(btVector3(2, btScalar(0.5), 2)),
                                            placeAt(btVector3(0, 3, 0)));
    shelf->body().setInterpolationWorldTransform(btTransform::getIdentity());
    return shelf;
  };
  EmptyWorld bullets;
  const auto missed = addShelf(bullets);
  const auto body = bulletsBody(bullets, btVector3(0, btScalar(4.1), 0));
  step(bullets, 40);
  EXPECT_LT(lowest(body->body()), 3);
  for (const bool surface : {false, true}) {
    TetskinWorld world;
    const auto shelf = addShelf(world);
    const double height = heightOver(world, surface, btVector3(0, btScalar(4.1), 0));
    EXPECT_NEAR(height, surface ? 3.5 : 3.65, 0.05);
  }
}

/// Bullet represents a plane by two triangles where it and a body first touch, and keeps them. The library's
/// counterpart is DeformableWorld.ABodySlidesAlongAPlaneAnyFar, for contact by nodes; here, the surface.
TEST(BulletsContact, LosesAPlaneWhereABodySlidesAlongIt) {
  constexpr double kHeight = 3.0;
  const auto slide = [](EmptyWorld& world, btSoftBody& body) {
    const Obstacle plane(world, std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(kHeight)),
                         placeAt(btVector3(0, 0, 0)));
    body.m_cfg.kDF = 0;
    body.addVelocity(btVector3(10, 0, 0));
    step(world, 60);
    return lowest(body) - kHeight;
  };
  const btVector3 above(0, btScalar(kHeight + 0.6), 0);
  EmptyWorld bullets;
  const auto body = bulletsBody(bullets, above);
  const double depth = slide(bullets, body->body());
  figure("height over a plane after a second, of a body that slides by ten of its sizes", depth);
  EXPECT_LT(depth, -0.5);
  TetskinWorld world;
  TouchingBody ours(world, boxMesh(Eigen::Vector3d(0.3, 0.3, 0.3)), above);
  EXPECT_NEAR(slide(world, ours.body->body()), -0.2, 0.1) << "the surface is this far within the cage";
}

/// The library's counterpart is ContactFilters.ForbidWhatBegins, for contact by the surface and by nodes.
TEST(BulletsContact, AsksOnlyTheRigidBodyWhetherItResponds) {
  EmptyWorld world;
  const auto body = bulletsBody(world, btVector3(0, btScalar(0.6), 0));
  btSoftBody& soft = body->body();
  soft.setCollisionFlags(soft.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  step(world, 60);
  EXPECT_GT(lowest(soft), -0.2);
}

/// The bounding box by which the broadphase finds partners encloses the nodes as they were when the step began.
TEST(BulletsContact, LooksForPartnersWhereABodyWas) {
  EmptyWorld world;
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  const auto body = added(world, looseCage(), options);
  btSoftBody& soft = body->body();
  soft.translate(btVector3(0, 5, 0));
  step(world, 1);
  soft.setVelocity(btVector3(0, -60, 0));
  world.softSolver->predictMotion(btScalar(1) / 60);
  btScalar predicted = BT_LARGE_FLOAT;
  for (int n = 0; n < soft.m_nodes.size(); ++n) predicted = std::min(predicted, soft.m_nodes[n].m_q.y());
  btVector3 low, high;
  soft.getAabb(low, high);
  figure("nodes' way beyond their box, of 1 in a step", static_cast<double>(low.y() - predicted));
  EXPECT_LT(predicted, low.y() - btScalar(0.9));
}

/// Bullet's distance field has cells of 0.25, whatever the size of the shape.
TEST(BulletsContact, HasADistanceFieldTooCoarseForSmallBodies) {
  const btScalar radius = btScalar(0.1);
  btSphereShape ball(radius);
  const ExactShape exact = *ExactShape::exactShape(ball);
  btSparseSdf<3> field;
  field.Initialize();
  double worst = 0.0, worstOfOurs = 0.0;
  for (const btVector3& p : pointsWithin(2 * radius, 1000)) {
    btVector3 normal;
    const btScalar distance = p.length() - radius;
    worst = std::max<double>(worst, std::abs(field.Evaluate(p, &ball, normal, 0) - distance));
    worstOfOurs = std::max<double>(worstOfOurs, std::abs(exact.distance(p).distance - distance));
  }
  figure("error of the distance from a ball of radius 0.1", worst);
  EXPECT_GT(worst, 0.04);
  EXPECT_LT(worstOfOurs, 1e-6);
}

}  // namespace
}  // namespace tetskin::test
