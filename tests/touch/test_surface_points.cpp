// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

Vector3d at(PointView<const btScalar> points, std::size_t v) {
  return {static_cast<double>(points[v][0]), static_cast<double>(points[v][1]), static_cast<double>(points[v][2])};
}

/// Rounding of positions at about one unit from the origin.
const double kRounding = 20 * static_cast<double>(SIMD_EPSILON);

class SurfacePoints : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(, SurfacePoints, testing::Values(0.38, 0.55),
                         [](const auto& value) { return value.param < 0.4 ? "Inside" : "Outside"; });

TEST_P(SurfacePoints, AreWhereALinearSkinDrawsTheirVertices) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(GetParam()));
  deform(body.body());
  ASSERT_EQ(body.skin.update(), StatusCode::Ok);
  for (std::size_t v = 0; v < body.model.mesh.vertexCount(); v += 7) {
    const SurfacePoint point = body.vertex(static_cast<int>(v));
    ASSERT_EQ(point.status(), StatusCode::Ok);
    EXPECT_LT((toEigen(*point.position()) - at(body.skin.positions(), v)).norm(), kRounding) << v;
    EXPECT_LT((toEigen(*point.position(body.skin)) - at(body.skin.positions(), v)).norm(), kRounding) << v;
  }
}

TEST_P(SurfacePoints, AreWhereAQuadraticSkinDrawsThem) {
  auto world = deformableWorld();
  BindingOptions quadratic;
  quadratic.interpolation = Interpolation::Quadratic;
  quadratic.order = VertexOrder::Sorted;
  TouchedBody body(*world, TouchModel(GetParam()), {}, quadratic);
  deform(body.body(), 0.12);
  ASSERT_EQ(body.skin.update(), StatusCode::Ok);
  double bent = 0;
  for (std::size_t v = 0; v < body.model.mesh.vertexCount(); v += 7) {
    const SurfacePoint point = body.vertex(static_cast<int>(v));
    const Vector3d drawn = at(body.skin.positions(), body.binding->embedding().vertexSlots()[v]);
    EXPECT_LT((toEigen(*point.position(body.skin)) - drawn).norm(), 10 * kRounding) << v;
    bent = std::max(bent, (toEigen(*point.position()) - drawn).norm());
  }
  EXPECT_GT(bent, 1e-3);  // the linear surface is a different one
}

TEST_P(SurfacePoints, FollowAQuadraticSkinWhoseBendsAreBounded) {
  auto world = deformableWorld();
  BindingOptions quadratic;
  quadratic.interpolation = Interpolation::Quadratic;
  TouchedBody body(*world, TouchModel(GetParam()), {}, quadratic);
  deform(body.body(), 2.0);
  ASSERT_EQ(body.skin.update(), StatusCode::Ok);
  for (std::size_t v = 0; v < body.model.mesh.vertexCount(); v += 7) {
    const Vector3d drawn = at(body.skin.positions(), v);
    EXPECT_LT((toEigen(*body.vertex(static_cast<int>(v)).position(body.skin)) - drawn).norm(), 100 * kRounding) << v;
  }
}

TEST(SurfacePoint, IsBetweenStepsWhereTheSkinDrawsIt) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 2.0));
  for (int s = 0; s < 3; ++s) {
    substep(*world);
    body.skin.recordStep();
  }
  const SurfacePoint point = body.vertex(11);
  for (const double alpha : {0.0, 0.3, 1.0}) {
    ASSERT_EQ(body.skin.update(static_cast<btScalar>(alpha)), StatusCode::Ok);
    EXPECT_LT(
        (toEigen(*point.position(body.skin, static_cast<btScalar>(alpha))) - at(body.skin.positions(), 11)).norm(),
        2 * kRounding);
  }
  EXPECT_GT((*point.position(body.skin, 0) - *point.position(body.skin, 1)).length(), 1e-4);
}

TEST(SurfacePoint, IsReadOfHiddenSkinsAndOfThoseWithAnOrigin) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  body.skin.setVisible(false);
  ASSERT_TRUE(body.skin.setOrigin(btVector3(5, 6, 7)).ok());
  deform(body.body());
  const SurfacePoint point = body.vertex(3);
  EXPECT_LT((*point.position(body.skin) - *point.position()).length(), 1e-6);
}

TEST(SurfacePoint, OfARestPositionIsTheNearestOfTheSurface) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38));
  const Vector3d centre(0.5, 0.4, 0.5);
  for (const Vector3d& rest : randomPoints(20, Box3(Vector3d(0, 0, 0), Vector3d(1, 1, 1)), 5)) {
    const Result<SurfacePoint> made = body.tree.pointAtRest(body.body(), rest);
    ASSERT_TRUE(made.ok());
    // A ball's nearest point lies straight outwards, except for its facets.
    const Vector3d wanted = centre + 0.38 * (rest - centre).normalized();
    EXPECT_LT((toEigen(*made.value().position()) - wanted).norm(), 0.02);
    EXPECT_GT(toEigen(made.value().frame()->normal).dot((rest - centre).normalized()), 0.99);
  }
}

/// Rotates and moves a body as a whole.
void turn(btSoftBody& body, const Eigen::AngleAxisd& by) {
  for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_x = toBullet(by * toEigen(body.m_nodes[n].m_x));
}

TEST(SurfacePoint, HasAFrameThatTurnsAsTheBodyDoes) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  const SurfacePoint point = body.vertex(40);
  const SurfaceFrame before = *point.frame();
  EXPECT_GT(toEigen(before.normal).dot((body.model.mesh.positions[40] - Vector3d(0.5, 0.4, 0.5)).normalized()), 0.999);
  const Eigen::AngleAxisd by(2.5, Vector3d(1, 2, -1).normalized());
  turn(body.body(), by);
  const SurfaceFrame after = *point.frame();
  EXPECT_LT((toEigen(after.normal) - by * toEigen(before.normal)).norm(), 1e-4);
  EXPECT_LT((toEigen(after.tangent) - by * toEigen(before.tangent)).norm(), 1e-4);
  EXPECT_LT((after.tangent.cross(after.bitangent) - after.normal).length(), 1e-5);
  EXPECT_NEAR(after.transform().getBasis().determinant(), 1, 1e-5);
  EXPECT_LT((after.transform().getBasis().getColumn(1) - after.normal).length(), 1e-6);
}

TEST(SurfacePoint, HasATangentThatTurnsLittleWhereTheBodyDeformsLittle) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 0.5));
  const SurfacePoint point = body.vertex(100);
  btVector3 before = point.frame()->tangent;
  for (int s = 0; s < 240; ++s) {  // it falls, lands and wobbles
    substep(*world);
    const btVector3 now = point.frame()->tangent;
    ASSERT_GT(now.dot(before), 0.95) << s;
    before = now;
  }
}

TEST(SurfacePoint, MovesByItsVelocity) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.55, 0.3));
  const SurfacePoint point = body.vertex(60);
  double maximum = 0;
  for (int s = 0; s < 200; ++s) {
    const Vector3d before = toEigen(*point.position());
    substep(*world);
    const Vector3d moved = (toEigen(*point.position()) - before) * 240;
    // Positions are rounded at some units from the origin.
    ASSERT_LT((moved - toEigen(*point.velocity())).norm(), 1e-4 * std::max(1.0, moved.norm()) + 240 * kRounding) << s;
    maximum = std::max(maximum, moved.norm());
  }
  EXPECT_GT(maximum, 1.0);
}

TEST(SurfacePoint, GivesTheBodyTheMomentumOfAnImpulse) {
  for (const double radius : {0.38, 0.55}) {
    auto world = deformableWorld();
    TouchedBody body(*world, TouchModel(radius));
    deform(body.body());
    for (const int v : {5, 200, 500}) {
      SurfacePoint point = body.vertex(v);
      const Momentum before(body.body());
      const btVector3 impulse(btScalar(0.3), btScalar(-0.1), btScalar(0.2));
      ASSERT_EQ(point.applyImpulse(impulse), StatusCode::Ok);
      const Momentum after(body.body());
      EXPECT_LT((after.linear - before.linear - toEigen(impulse)).norm(), 1e-6);
      EXPECT_LT((after.angular - before.angular - toEigen(*point.position()).cross(toEigen(impulse))).norm(), 1e-6);
    }
  }
}

TEST(SurfacePoint, LeavesTheMomentumOfAnImpulseThroughSteps) {
  auto world = deformableWorld();
  TouchedBody body(*world, TouchModel(0.38, 3.0));
  SurfacePoint point = body.vertex(200);
  const btVector3 impulse(btScalar(0.3), btScalar(-0.1), btScalar(0.2));
  ASSERT_EQ(point.applyImpulse(impulse), StatusCode::Ok);
  for (int s = 0; s < 20; ++s) substep(*world);
  EXPECT_LT((Momentum(body.body()).linear - toEigen(impulse)).norm(), 5e-3 * static_cast<double>(impulse.length()));
}

TEST(SurfacePoint, LosesToPinnedNodesWhatTheyTake) {
  auto world = deformableWorld();
  SoftBodyOptions pinned;
  pinned.pinned = [](const Vector3d& rest) { return rest.y() < 0.3; };
  TouchedBody body(*world, TouchModel(), pinned);
  SurfacePoint low = body.vertex(body.furthest(-Vector3d::UnitY())),
               high = body.vertex(body.furthest(Vector3d::UnitY()));
  ASSERT_EQ(low.applyImpulse(btVector3(1, 0, 0)), StatusCode::Ok);
  EXPECT_LT(Momentum(body.body()).linear.norm(), 0.999);
  const Momentum before(body.body());
  ASSERT_EQ(high.applyImpulse(btVector3(1, 0, 0)), StatusCode::Ok);
  EXPECT_LT((Momentum(body.body()).linear - before.linear - Vector3d::UnitX()).norm(), 1e-6);
}

TEST(SurfacePoint, WakesWhatItPushes) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  body.body().forceActivationState(ISLAND_SLEEPING);
  SurfacePoint point = body.vertex(0);
  ASSERT_EQ(point.applyImpulse(btVector3(0, btScalar(0.1), 0)), StatusCode::Ok);
  EXPECT_TRUE(body.body().isActive());
  body.body().forceActivationState(ISLAND_SLEEPING);
  ASSERT_EQ(point.applyForce(btVector3(0, btScalar(0.1), 0)), StatusCode::Ok);
  EXPECT_TRUE(body.body().isActive());
}

TEST(SurfacePoint, HasTheMassThatItsVelocityTells) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  SurfacePoint point = body.vertex(77);
  const double mass = static_cast<double>(point.effectiveMass());
  ASSERT_EQ(point.applyImpulse(btVector3(0, 1, 0)), StatusCode::Ok);
  EXPECT_NEAR(static_cast<double>(point.velocity()->y()) * mass, 1, 1e-4);
}

}  // namespace
}  // namespace tetskin::test
