// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Functions that work in any world: reading points and casting rays.
void readAndCast(TestWorld& world, const TouchModel& model) {
  SoftBodySkin skin;
  const auto binding = model.bind();
  ASSERT_TRUE(skin.bind(world.body(), binding).ok());
  const SurfaceTree tree = SurfaceTree::create(binding, model.mesh).value();
  const SurfacePoint point = tree.pointAtVertex(world.body(), 60).value();
  double worst = 0, fastest = 0;
  for (int s = 0; s < 120; ++s) {
    const Vector3d before = toEigen(*point.position());
    world.world->stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    const Vector3d moved = (toEigen(*point.position()) - before) * 240;
    worst = std::max(worst, (moved - toEigen(*point.velocity())).norm() / std::max(1.0, moved.norm()));
    fastest = std::max(fastest, moved.norm());
  }
  EXPECT_GT(fastest, 1.0);
  EXPECT_LT(worst, 1e-3);
  const btVector3 centroid = *point.position();
  const SurfaceHit hit = tree.raycast(skin, centroid + btVector3(0, 3, 0), centroid - btVector3(0, 3, 0));
  ASSERT_TRUE(hit);
  EXPECT_LT((*tree.pointAt(world.body(), hit).value().position() - hit.point).length(), 1e-5);
}

template <class World>
class ClassicWorlds : public testing::Test {};
using Classic = testing::Types<RigidWorld, MultiBodyWorld>;
TYPED_TEST_SUITE(ClassicWorlds, Classic);

TYPED_TEST(ClassicWorlds, LetPointsBeReadAndPushed) {
  const TouchModel model(0.38, 2.0);
  TypeParam world(model.cage);
  readAndCast(world, model);
  const SurfaceTree tree = SurfaceTree::create(model.bind(), model.mesh).value();
  SurfacePoint point = tree.pointAtVertex(world.body(), 60).value();
  const Momentum before(world.body());
  ASSERT_EQ(point.applyImpulse(btVector3(0, 1, 0)), StatusCode::Ok);
  const Momentum after(world.body());
  EXPECT_LT((after.linear - before.linear - Vector3d::UnitY()).norm(), 1e-5);
  world.world->stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  EXPECT_NEAR(Momentum(world.body()).linear.y(), after.linear.y() - 10.0 / 240, 0.02);
}

TYPED_TEST(ClassicWorlds, RefuseContinuousForcesSpringsAndWelds) {
  const TouchModel model(0.38, 2.0);
  TypeParam world(model.cage);
  const SurfaceTree tree = SurfaceTree::create(model.bind(), model.mesh).value();
  SurfacePoint point = tree.pointAtVertex(world.body(), 60).value();
  EXPECT_EQ(point.applyForce(btVector3(0, 1, 0)), StatusCode::InvalidOption);
  EXPECT_EQ(tree.applyForce(world.body(), {*point.position(), 1, 1}).status, StatusCode::InvalidOption);
  EXPECT_EQ(SurfaceSpring::add(*world.world, point).status().code, StatusCode::InvalidOption);
  btSphereShape shape(1);
  btRigidBody ball(1, nullptr, &shape);
  EXPECT_EQ(SurfaceWeld::add(*world.world, point, ball).status().code, StatusCode::InvalidOption);
}

/// Runs with Bullet's forces in Bullet's solver, explicit and implicit.
TEST(BulletsSolver, LetsPointsBeReadAndPushedAtOnceAndNothingElse) {
  for (const bool implicit : {false, true}) {
    const TouchModel model(0.38, 3.0);
    EmptyWorld world;
    world.deformable().setGravity(btVector3(0, 0, 0));
    SoftBodyOptions options;
    options.forceModel = ForceModel::NeoHookean;
    options.implicit = implicit;
    TouchedBody body(world, model, options);
    substep(world);
    SurfacePoint point = body.vertex(250);
    ASSERT_TRUE(body.tree.raycast(body.skin, *point.position() * 2, btVector3(0.5, 3.4, 0.5)));
    const Vector3d given(0.1, -0.2, 0.05);
    ASSERT_EQ(point.applyImpulse(toBullet(given)), StatusCode::Ok);
    for (int s = 0; s < 5; ++s) substep(world);
    EXPECT_LT((Momentum(body.body()).linear - given).norm(), 0.02 * given.norm()) << implicit;
    const Vector3d before = toEigen(*point.position());
    substep(world);
    const Vector3d moved = (toEigen(*point.position()) - before) * 240;
    EXPECT_LT((moved - toEigen(*point.velocity())).norm(), 1e-3 * moved.norm() + 1e-4);

    EXPECT_EQ(point.applyForce(btVector3(0, 1, 0)), StatusCode::InvalidOption);
    EXPECT_EQ(body.tree.applyForce(body.body(), {*point.position(), 1, 1}).status, StatusCode::InvalidOption);
    btSphereShape shape(1);
    btRigidBody ball(1, nullptr, &shape);
    for (const Status& status : {SurfaceSpring::add(*world.world, point).status(),
                                 SurfaceSpring::add(*world.world, point, ball, btVector3(0, 0, 0)).status(),
                                 SurfaceWeld::add(*world.world, point, ball).status()}) {
      EXPECT_EQ(status.code, StatusCode::InvalidOption);
      EXPECT_NE(status.message.find("DeformableSolver"), std::string::npos) << status.message;
    }
  }
}

TEST(ReducedWorlds, LetPointsBeReadAndNotPushed) {
  const TouchModel model(0.38, 2.0);
  ReducedWorld world(model.cage);
  SoftBodySkin skin;
  const auto binding = model.bind();
  ASSERT_TRUE(skin.bind(world.body(), binding).ok());
  const SurfaceTree tree = SurfaceTree::create(binding, model.mesh).value();
  SurfacePoint point = tree.pointAtVertex(world.body(), 60).value();
  for (int s = 0; s < 30; ++s) world.world->stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  const btVector3 centroid = *point.position();
  EXPECT_LT(centroid.y(), 2.75);
  ASSERT_TRUE(tree.raycast(skin, centroid + btVector3(0, 3, 0), centroid - btVector3(0, 3, 0)));
  EXPECT_EQ(point.applyImpulse(btVector3(0, 1, 0)), StatusCode::InvalidOption);
  EXPECT_EQ(point.applyForce(btVector3(0, 1, 0)), StatusCode::InvalidOption);
  EXPECT_EQ(SurfaceSpring::add(*world.world, point).status().code, StatusCode::InvalidOption);
  const Vector3d before = toEigen(*point.position());
  world.world->stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  const Vector3d moved = (toEigen(*point.position()) - before) * 240;
  EXPECT_LT((moved - toEigen(*point.velocity())).norm(), 1e-3 * moved.norm());
}

}  // namespace
}  // namespace tetskin::test
