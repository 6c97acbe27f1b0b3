// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies that are taken out of their world, and put back or into another one.
#include <tetskin/bullet/soft_body_skin.h>

#include "deformable_test.h"

namespace tetskin::test {
namespace {

int forcesIn(EmptyWorld& world) {
  return static_cast<btDeformableBodySolver*>(world.softSolver.get())->getLagrangianForceArray()->size();
}

/// The nodes of a body after 30 frames. If it is taken out of the world, this happens before the 15th.
std::vector<btVector3> after(bool takenOut, const std::function<void(DeformableBody&)>& prepare,
                             const SoftBodyOptions& options = {}) {
  const auto world = worldFor(options.forceModel);
  const auto body = added(*world, smallCageAbove(50), options);
  prepare(*body);
  step(*world, 15);
  if (takenOut) {
    body->removeFromWorld();
    EXPECT_EQ(body->solverPath(), SolverPath::None);
    EXPECT_EQ(world->deformable().getSoftBodyArray().size(), 0);
    step(*world, 10);
    EXPECT_TRUE(body->addToWorld(world->deformable()).ok());
    EXPECT_NE(body->solverPath(), SolverPath::None);
  }
  step(*world, 15);
  return nodesOf(body->body());
}

void swing(DeformableBody& body) {
  for (int n = 0; n < body.body().m_nodes.size(); ++n) {
    if (body.body().m_nodes[n].m_x.x() > btScalar(0.1)) continue;
    EXPECT_TRUE(body.setPinned(n).ok());
  }
}
void spin(DeformableBody& body) {
  body.body().addVelocity(btVector3(1, 0, 0), 3);
}

TEST(BodiesThatReturn, GoOnToTheBitWhereTheyWereTakenOut) {
  const auto nothing = [](DeformableBody&) {};
  const auto weightless = [](DeformableBody& body) { EXPECT_TRUE(body.setGravity(btVector3(1, 0, 0)).ok()); };
  const auto stiffened = [](DeformableBody& body) { EXPECT_TRUE(body.setYoungsModulus(1e6).ok()); };
  for (const std::function<void(DeformableBody&)>& prepare :
       std::vector<std::function<void(DeformableBody&)>>{nothing, swing, spin, weightless, stiffened}) {
    EXPECT_EQ(after(true, prepare), after(false, prepare));
  }
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::LinearElasticity}) {
    SoftBodyOptions options;
    options.forceModel = model;
    EXPECT_EQ(after(true, spin, options), after(false, spin, options));
  }
}

TEST(BodiesThatReturn, LieWhereTheyLayAndSleepAgain) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(0.05));
  step(world, 400);
  ASSERT_FALSE(body->body().isActive());
  const std::vector<btVector3> lay = nodesOf(body->body());
  body->removeFromWorld();
  step(world, 10);
  ASSERT_TRUE(body->addToWorld(world.deformable()).ok());
  step(world, 200);
  EXPECT_FALSE(body->body().isActive());
  for (std::size_t n = 0; n < lay.size(); ++n) {
    EXPECT_LT((body->body().m_nodes[static_cast<int>(n)].m_x - lay[n]).length(), 2e-4);
  }
}

TEST(BodiesThatReturn, FallIfWhatTheyLayOnHasGone) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(0.05));
  step(world, 400);
  ASSERT_FALSE(body->body().isActive());
  body->removeFromWorld();
  btRigidBody* ground = btRigidBody::upcast(world.deformable().getCollisionObjectArray()[0]);
  world.deformable().removeRigidBody(ground);
  ASSERT_TRUE(body->addToWorld(world.deformable()).ok());
  step(world, 60);
  EXPECT_LT(lowest(body->body()), -4);
  world.deformable().addRigidBody(ground);
}

TEST(BodiesThatReturn, MayGoToAnotherWorldWithItsGravityAndItsFloor) {
  TetskinWorld first, second;
  second.deformable().setGravity(btVector3(0, -2, 0));
  const TetMesh cage = smallCageAbove(0.2);
  const auto body = added(first, cage);
  const auto stays = added(first, smallCageAbove(3));
  SoftBodySkin skin;
  ASSERT_TRUE(skin.bind(body->body(), cage, sphere(8, 0.2, Eigen::Vector3d(0.3, 0.5, 0.4))).ok());
  step(first, 3);
  body->removeFromWorld();
  EXPECT_EQ(forcesIn(first), 4);  // two of them do nothing until the next body comes
  ASSERT_TRUE(body->addToWorld(second.deformable()).ok());
  EXPECT_EQ(second.deformable().getSoftBodyArray().size(), 1);
  step(second, 300);
  EXPECT_NEAR(lowest(body->body()), body->body().getCollisionShape()->getMargin(), 0.02);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_LT(skin.bounds().min().y(), 0.35);
  step(first, 3);
  body->removeFromWorld();
  ASSERT_TRUE(body->addToWorld(first.deformable()).ok());
  step(first, 3);
  EXPECT_EQ(body->solverPath(), SolverPath::Solver);
}

TEST(BodiesThatReturn, AreRefusedWhereTheyCannotBe) {
  TetskinWorld world, other;
  EmptyWorld bullets;
  const auto body = added(world, smallCageAbove(3));
  EXPECT_EQ(body->addToWorld(world.deformable()).code, StatusCode::InvalidOption);
  EXPECT_EQ(body->addToWorld(other.deformable()).code, StatusCode::InvalidOption);
  body->removeFromWorld();
  body->removeFromWorld();  // once more changes nothing
  EXPECT_EQ(body->addToWorld(bullets.deformable()).code, StatusCode::InvalidOption);
  other.deformable().setGravity(btVector3(0, btScalar(-1e9), 0));
  EXPECT_EQ(body->addToWorld(other.deformable()).code, StatusCode::InvalidOption);
  EXPECT_EQ(body->solverPath(), SolverPath::None);
  EXPECT_TRUE(body->addToWorld(world.deformable()).ok());
}

TEST(BodiesThatReturn, AlsoIfTheApplicationHasMovedThemByBulletsCalls) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(3));
  world.deformable().removeSoftBody(&body->body());
  ASSERT_TRUE(body->addToWorld(world.deformable()).ok());
  world.deformable().removeSoftBody(&body->body());
  world.deformable().addSoftBody(&body->body());
  EXPECT_EQ(body->solverPath(), SolverPath::None);
  ASSERT_TRUE(body->addToWorld(world.deformable()).ok());
  step(world, 6);
  EXPECT_NEAR(lowest(body->body()), 3 - 0.05 * 1, 0.01);
}

TEST(BodiesThatReturn, WakeWhatLayOnThem) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(0.05));
  btBoxShape shape(btVector3(1, 1, 1) * btScalar(0.25));
  btRigidBody box(btScalar(0.2), nullptr, &shape, btVector3(1, 1, 1) * btScalar(0.01));
  const btVector3 above(btScalar(0.3), btScalar(0.95), btScalar(0.45));
  box.setWorldTransform(btTransform(btQuaternion::getIdentity(), above));
  world.deformable().addRigidBody(&box);
  step(world, 400);
  ASSERT_FALSE(box.isActive());
  const btScalar before = box.getWorldTransform().getOrigin().y();
  body->removeFromWorld();
  step(world, 30);
  EXPECT_LT(box.getWorldTransform().getOrigin().y(), before - btScalar(0.3));
  world.deformable().removeRigidBody(&box);
}

TEST(BodiesThatReturn, KeepTheirFilters) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(3));
  body->body().getBroadphaseHandle()->m_collisionFilterMask = 64;
  body->removeFromWorld();
  ASSERT_TRUE(body->addToWorld(world.deformable()).ok());
  EXPECT_EQ(body->body().getBroadphaseHandle()->m_collisionFilterMask, 64);
}

TEST(BodiesThatReturn, AndTheirWorldsMayGoInAnyOrder) {
  auto first = std::make_unique<TetskinWorld>();
  TetskinWorld second;
  auto out = added(*first, smallCageAbove(3)), moved = added(*first, smallCageAbove(5));
  step(*first, 2);
  out->removeFromWorld();
  moved->removeFromWorld();
  first.reset();
  out.reset();
  ASSERT_TRUE(moved->addToWorld(second.deformable()).ok());
  const double before = lowest(moved->body());
  step(second, 15);
  EXPECT_EQ(moved->solverPath(), SolverPath::Solver);
  EXPECT_NEAR(lowest(moved->body()) - before, -10 * (0.25 / 30 + 0.25 * 0.25 / 2), 0.02) << "gravity acts once";
  moved.reset();
  EXPECT_EQ(second.deformable().getSoftBodyArray().size(), 0);
}

}  // namespace
}  // namespace tetskin::test
