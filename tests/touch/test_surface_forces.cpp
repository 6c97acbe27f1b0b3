// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

TEST(SurfaceForces, GiveInAStepTheirImpulse) {
  for (const double radius : {0.38, 0.55}) {
    auto world = deformableWorld();
    TouchedBody of(*world, TouchModel(radius, 3.0));
    SurfacePoint point = of.vertex(250);
    const btVector3 force(20, -30, 10);
    const btVector3 at = *point.position();
    ASSERT_EQ(point.applyForce(force), TouchStatus::Ok);
    substep(*world);
    const Momentum first(of.body());
    const Vector3d given = toEigen(force) / 240;
    EXPECT_LT((first.linear - given).norm(), 5e-3 * given.norm());
    EXPECT_LT((first.angular - toEigen(at).cross(given)).norm(), 1e-2 * toEigen(at).cross(given).norm());
    substep(*world);  // once, and no more
    EXPECT_LT((Momentum(of.body()).linear - first.linear).norm(), 5e-3 * given.norm());
  }
}

TEST(SurfaceForces, ActForAsManyStepsAsTheyAreToldAndAddUp) {
  auto world = deformableWorld();
  TouchedBody of(*world, TouchModel(0.38, 3.0));
  SurfacePoint point = of.vertex(250), other = of.vertex(20);
  ASSERT_EQ(point.applyForce(btVector3(0, 0, 24), 4), TouchStatus::Ok);
  ASSERT_EQ(other.applyForce(btVector3(24, 0, 0), 2), TouchStatus::Ok);
  for (int s = 0; s < 8; ++s) substep(*world);
  EXPECT_LT((Momentum(of.body()).linear - Vector3d(0.2, 0, 0.4)).norm(), 0.005);
}

TEST(SurfaceForces, OutliveTheirPoint) {
  auto world = deformableWorld();
  TouchedBody of(*world, TouchModel(0.38, 3.0));
  ASSERT_EQ(of.vertex(250).applyForce(btVector3(0, 0, 24)), TouchStatus::Ok);
  substep(*world);
  EXPECT_NEAR(Momentum(of.body()).linear.z(), 0.1, 0.001);
}

/// A bar that is held at one end, and pulled at the other: how far it sags.
double sagOf(EmptyWorld& world, SurfacePoint& tip) {
  const double start = static_cast<double>(tip.position()->y());
  for (int s = 0; s < 1200; ++s) {
    EXPECT_EQ(tip.applyForce(btVector3(0, -1, 0)), TouchStatus::Ok);
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
    TouchedBody of(*world, bar, held);
    SurfacePoint tip = of.vertex(of.furthest(Vector3d::UnitX()));
    sags[k] = sagOf(*world, tip);
  }
  EXPECT_GT(sags[0], 0.005);
  EXPECT_NEAR(sags[0] / sags[1], 2.0, 0.05);
}

TEST(SurfaceForces, OfAnExplosionAddUpToWhatIsTold) {
  for (const double radius : {0.38, 0.55}) {
    auto world = deformableWorld();
    TouchedBody of(*world, TouchModel(radius, 3.0));
    deform(of.body());
    const SurfaceBlast blast{btVector3(btScalar(0.2), btScalar(2.9), btScalar(0.3)), btScalar(0.7), 2};
    const SurfacePush push = of.tree.applyImpulse(of.body(), blast);
    ASSERT_EQ(push.status, TouchStatus::Ok);
    EXPECT_GT(push.vertices, 50u);
    const Momentum after(of.body());
    EXPECT_LT((after.linear - toEigen(push.linear)).norm(), 2e-6);
    EXPECT_LT((after.angular - toEigen(push.angular)).norm(), 1e-5);
    EXPECT_GT(toEigen(push.linear).dot(Vector3d(0.5, 3.4, 0.5) - toEigen(blast.centre)), 0.1);  // away from it
    EXPECT_LE(push.linear.length(), 2);
  }
}

TEST(SurfaceForces, OfAContinuousExplosionAreTheSameThroughAStep) {
  auto world = deformableWorld();
  TouchedBody of(*world, TouchModel(0.38, 3.0));
  const SurfaceBlast blast{btVector3(btScalar(0.2), btScalar(2.9), btScalar(0.3)), btScalar(0.7), 240};
  const SurfacePush push = of.tree.applyForce(of.body(), blast);
  ASSERT_EQ(push.status, TouchStatus::Ok);
  substep(*world);
  EXPECT_LT((Momentum(of.body()).linear - toEigen(push.linear) / 240).norm(), 0.01);
}

TEST(SurfaceBlast, IsWeightedByAreaAndDistance) {
  auto world = deformableWorld();
  TouchedBody of(*world, TouchModel(0.38));
  const Vector3d centre(0.5, 1.1, 0.5);
  const SurfaceBlast blast{toBullet(centre), btScalar(0.6), 3};
  // By all vertices, another way.
  Vector3d sum = Vector3d::Zero();
  double total = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < of.model.mesh.vertexCount(); ++v) {
    double area = 0;
    for (const auto& [a, b, c] : of.model.mesh.triangles) {
      if (a != static_cast<int>(v) && b != static_cast<int>(v) && c != static_cast<int>(v)) continue;
      const auto& p = of.model.mesh.positions;
      area += 0.5 * (p[b] - p[a]).cross(p[c] - p[a]).norm() / 3;
    }
    const Vector3d away = of.model.mesh.positions[v] - centre;
    const double part = area * (1 - away.norm() / 0.6);
    if (part <= 0) continue;
    sum += part * away.normalized();
    total += part;
    ++count;
  }
  const SurfacePush push = of.tree.applyImpulse(of.body(), blast);
  EXPECT_EQ(push.vertices, count);
  EXPECT_LT((toEigen(push.linear) - 3 / total * sum).norm(), 1e-4);
}

TEST(SurfaceBlast, SaysWhyItPushesNothing) {
  auto world = deformableWorld();
  TouchedBody of(*world);
  const btVector3 far(50, 0, 0), near(0, 0, 0);
  EXPECT_EQ(of.tree.applyImpulse(of.body(), {far, 1, 1}).status, TouchStatus::Miss);
  EXPECT_EQ(of.tree.applyImpulse(of.body(), {near, 0, 1}).status, TouchStatus::InvalidOption);
  EXPECT_EQ(of.tree.applyImpulse(of.body(), {near, -1, 1}).status, TouchStatus::InvalidOption);
  EXPECT_EQ(of.tree.applyImpulse(of.body(), {near, 1, btScalar(NAN)}).status, TouchStatus::NonFinite);
  EXPECT_EQ(of.tree.applyForce(of.body(), {near, 1, 1}, 0).status, TouchStatus::InvalidOption);
  const auto small = added(*world, smallCageAbove(5));
  EXPECT_EQ(of.tree.applyImpulse(small->body(), {near, 1, 1}).status, TouchStatus::OtherBody);
  EXPECT_EQ(Momentum(of.body()).linear.norm(), 0);
}

}  // namespace
}  // namespace tetskin::test
