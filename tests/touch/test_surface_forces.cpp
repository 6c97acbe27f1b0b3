// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

TEST(SurfaceForces, GiveInAStepTheirImpulse) {
  for (const double radius : {0.38, 0.55}) {
    auto world = deformableWorld();
    TouchedBody body(*world, TouchModel(radius, 3.0));
    SurfacePoint point = body.vertex(250);
    const btVector3 force(20, -30, 10);
    const btVector3 at = *point.position();
    ASSERT_EQ(point.applyForce(force), StatusCode::Ok);
    substep(*world);
    const Momentum first(body.body());
    const Vector3d given = toEigen(force) / 240;
    EXPECT_LT((first.linear - given).norm(), 5e-3 * given.norm());
    EXPECT_LT((first.angular - toEigen(at).cross(given)).norm(), 1e-2 * toEigen(at).cross(given).norm());
    substep(*world);  // the force acts once only
    EXPECT_LT((Momentum(body.body()).linear - first.linear).norm(), 5e-3 * given.norm());
  }
}

TEST(SurfaceForces, ActForAsManyStepsAsTheyAreToldAndAddUp) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  SurfacePoint point = body.vertex(250), other = body.vertex(20);
  ASSERT_EQ(point.applyForce(btVector3(0, 0, 24), 4), StatusCode::Ok);
  ASSERT_EQ(other.applyForce(btVector3(24, 0, 0), 2), StatusCode::Ok);
  for (int s = 0; s < 8; ++s) substep(*world);
  EXPECT_LT((Momentum(body.body()).linear - Vector3d(0.2, 0, 0.4)).norm(), 0.005);
}

TEST(SurfaceForces, OutliveTheirPoint) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  ASSERT_EQ(body.vertex(250).applyForce(btVector3(0, 0, 24)), StatusCode::Ok);
  substep(*world);
  EXPECT_NEAR(Momentum(body.body()).linear.z(), 0.1, 0.001);
}

/// How far a bar sags that is pinned at one end and pulled at the other.
double sagOf(EmptyWorld& world, SurfacePoint& tip) {
  const double start = static_cast<double>(tip.position()->y());
  for (int s = 0; s < 1200; ++s) {
    EXPECT_EQ(tip.applyForce(btVector3(0, -1, 0)), StatusCode::Ok);
    substep(world);
  }
  return start - static_cast<double>(tip.position()->y());
}

TEST(SurfaceForces, BendABarInInverseProportionToItsStiffness) {
  TouchModel bar;
  bar.cage = latticeCage(16, 3, 3, 0.1);
  bar.mesh = sphere(10, 0.1, {1.45, 0.15, 0.15});
  for (auto* points : {&bar.cage.nodes, &bar.mesh.positions}) {
    for (Vector3d& p : *points) p.y() += 2;
  }
  double sags[2];
  for (const int k : {0, 1}) {
    SoftBodyOptions held;
    held.pinned = [](const Vector3d& rest) { return rest.x() < 0.05; };
    held.youngsModulus = 3e4 * (1 + k);
    auto world = deformableWorld();
    TouchedBody body(*world, bar, held);
    SurfacePoint tip = body.vertex(body.furthest(Vector3d::UnitX()));
    sags[k] = sagOf(*world, tip);
  }
  EXPECT_GT(sags[0], 0.005);
  EXPECT_NEAR(sags[0] / sags[1], 2.0, 0.05);
}

TEST(SurfaceForces, OfAnExplosionAddUpToWhatIsTold) {
  for (const double radius : {0.38, 0.55}) {
    auto world = deformableWorld();
    TouchedBody body(*world, TouchModel(radius, 3.0));
    deform(body.body());
    const RadialImpulse impulse{btVector3(btScalar(0.2), btScalar(2.9), btScalar(0.3)), btScalar(0.7), 2};
    const ImpulseResult push = body.tree.applyImpulse(body.body(), impulse);
    ASSERT_EQ(push.status, StatusCode::Ok);
    EXPECT_GT(push.vertices, 50u);
    const Momentum after(body.body());
    EXPECT_LT((after.linear - toEigen(push.linear)).norm(), 2e-6);
    EXPECT_LT((after.angular - toEigen(push.angular)).norm(), 1e-5);
    EXPECT_GT(toEigen(push.linear).dot(Vector3d(0.5, 3.4, 0.5) - toEigen(impulse.centre)),
              0.1);  // away from the centre
    EXPECT_LE(push.linear.length(), 2);
  }
}

TEST(SurfaceForces, OfAContinuousExplosionAreTheSameThroughAStep) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  const RadialImpulse force{btVector3(btScalar(0.2), btScalar(2.9), btScalar(0.3)), btScalar(0.7), 240};
  const ImpulseResult push = body.tree.applyForce(body.body(), force);
  ASSERT_EQ(push.status, StatusCode::Ok);
  substep(*world);
  EXPECT_LT((Momentum(body.body()).linear - toEigen(push.linear) / 240).norm(), 0.01);
}

TEST(RadialImpulse, IsWeightedByAreaAndDistance) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38));
  const Vector3d centre(0.5, 1.1, 0.5);
  const RadialImpulse impulse{toBullet(centre), btScalar(0.6), 3};
  // The same sum, computed over all vertices.
  Vector3d sum = Vector3d::Zero();
  double total = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < body.model.mesh.vertexCount(); ++v) {
    double area = 0;
    for (const auto& [a, b, c] : body.model.mesh.triangles) {
      if (a != static_cast<int>(v) && b != static_cast<int>(v) && c != static_cast<int>(v)) continue;
      const auto& p = body.model.mesh.positions;
      area += 0.5 * (p[b] - p[a]).cross(p[c] - p[a]).norm() / 3;
    }
    const Vector3d away = body.model.mesh.positions[v] - centre;
    const double part = area * (1 - away.norm() / 0.6);
    if (part <= 0) continue;
    sum += part * away.normalized();
    total += part;
    ++count;
  }
  const ImpulseResult push = body.tree.applyImpulse(body.body(), impulse);
  EXPECT_EQ(push.vertices, count);
  EXPECT_LT((toEigen(push.linear) - 3 / total * sum).norm(), 1e-4);
}

TEST(RadialImpulse, SaysWhyItPushesNothing) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  const btVector3 far(50, 0, 0), near(0, 0, 0);
  EXPECT_EQ(body.tree.applyImpulse(body.body(), {far, 1, 1}).status, StatusCode::NoHit);
  EXPECT_EQ(body.tree.applyImpulse(body.body(), {near, 0, 1}).status, StatusCode::InvalidOption);
  EXPECT_EQ(body.tree.applyImpulse(body.body(), {near, -1, 1}).status, StatusCode::InvalidOption);
  EXPECT_EQ(body.tree.applyImpulse(body.body(), {near, 1, btScalar(NAN)}).status, StatusCode::NonFinite);
  EXPECT_EQ(body.tree.applyForce(body.body(), {near, 1, 1}, 0).status, StatusCode::InvalidOption);
  const auto small = added(*world, smallCageAbove(5));
  EXPECT_EQ(body.tree.applyImpulse(small->body(), {near, 1, 1}).status, StatusCode::OtherBody);
  EXPECT_EQ(Momentum(body.body()).linear.norm(), 0);
}

}  // namespace
}  // namespace tetskin::test
