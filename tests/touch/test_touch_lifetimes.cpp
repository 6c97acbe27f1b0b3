// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/snapshot.h>
#include <tetskin/touch/src/points/point_data.h>
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Number of forces in a world.
int forceCount(TouchedBody& body) {
  return static_cast<btDeformableBodySolver*>(body.body().getSoftBodySolver())->getLagrangianForceArray()->size();
}

TEST(TouchLifetime, PointsSayThatTheirBodyIsGone) {
  auto world = deformableWorld();
  auto body = std::make_unique<TouchedBody>(*world);
  SurfacePoint point = body->vertex(5);
  body.reset();
  EXPECT_EQ(point.status(), StatusCode::BodyDeleted);
  EXPECT_FALSE(point.position());
  EXPECT_FALSE(point.velocity());
  EXPECT_FALSE(point.frame());
  EXPECT_EQ(point.effectiveMass(), 0);
  EXPECT_EQ(point.body(), nullptr);
  EXPECT_EQ(point.applyImpulse(btVector3(1, 0, 0)), StatusCode::BodyDeleted);
  EXPECT_EQ(point.applyForce(btVector3(1, 0, 0)), StatusCode::BodyDeleted);
}

TEST(TouchLifetime, PointsOfNobodySaySo) {
  SurfacePoint point;
  EXPECT_EQ(point.status(), StatusCode::Released);
  EXPECT_FALSE(point.position());
  EXPECT_EQ(point.applyImpulse(btVector3(1, 0, 0)), StatusCode::Released);
  auto world = deformableWorld();
  TouchedBody body(*world);
  point = body.vertex(3);
  EXPECT_EQ(point.status(), StatusCode::Ok);
  point.release();
  EXPECT_EQ(point.status(), StatusCode::Released);
  EXPECT_STREQ(toString(point.status()), "released");
}

TEST(TouchLifetime, PointsSayThatTheTopologyHasChanged) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  SurfacePoint point = body.vertex(5);
  auto own = createSoftBody(body.model.cage, world->deformable().getWorldInfo()).value();
  SurfacePoint other = body.tree.pointAtVertex(*own, 5).value();
  own->appendNode(btVector3(9, 9, 9), 1);
  EXPECT_EQ(other.status(), StatusCode::TopologyChanged);
  EXPECT_EQ(other.applyImpulse(btVector3(1, 0, 0)), StatusCode::TopologyChanged);
  EXPECT_EQ(point.status(), StatusCode::Ok);
}

TEST(TouchLifetime, PointsSayThatTheirNodesAreNoNumbers) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  SurfacePoint point = body.vertex(5);
  body.body().m_nodes[touch_detail::dataOf(point).corners[0].nodes[2]].m_x.setY(INFINITY);
  EXPECT_EQ(point.status(), StatusCode::NonFinite);
  EXPECT_EQ(point.applyImpulse(btVector3(1, 0, 0)), StatusCode::NonFinite);
}

TEST(TouchLifetime, PointsAreNotReadOfSkinsOfOtherBodies) {
  auto world = deformableWorld();
  TouchedBody first(*world), second(*world);
  EXPECT_FALSE(first.vertex(5).position(second.skin));
  EXPECT_FALSE(first.vertex(5).position(SoftBodySkin()));
  EXPECT_TRUE(first.vertex(5).position(first.skin));
}

TEST(TouchLifetime, SpringsLeaveNothingInTheWorld) {
  auto world = deformableWorld(10);
  TouchedBody body(*world);
  substep(*world);
  RigidBox box(*world, 1, btVector3(0, 3, 0));
  const int before = forceCount(body);
  {
    auto spring = SurfaceSpring::add(world->deformable(), body.vertex(5)).value();
    auto weld = SurfaceWeld::add(world->deformable(), body.vertex(50), *box).value();
    substep(*world);
    EXPECT_EQ(spring->status(), StatusCode::Ok);
    EXPECT_EQ(forceCount(body), before + 1);
    spring->release();
    EXPECT_EQ(spring->status(), StatusCode::Released);
    EXPECT_EQ(spring->setTarget(btVector3(0, 0, 0)), StatusCode::Released);
    substep(*world);
  }
  for (int s = 0; s < 10; ++s) substep(*world);
  EXPECT_TRUE(isFinite(body.body()));
}

TEST(TouchLifetime, ARigidBodyAtTheAddressOfOneThatWasWeldedIsFree) {
  auto world = deformableWorld(10);
  TouchedBody body(*world);
  const SurfacePoint point = body.vertex(body.furthest(-Vector3d::UnitY()));
  btSphereShape shape(btScalar(0.1));
  alignas(btRigidBody) unsigned char memory[sizeof(btRigidBody)];
  const auto place = [&](const btVector3& at) {
    btVector3 inertia;
    shape.calculateLocalInertia(btScalar(0.5), inertia);
    auto* sphere = new (memory) btRigidBody(btScalar(0.5), nullptr, &shape, inertia);
    sphere->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    world->deformable().addRigidBody(sphere);
    return sphere;
  };
  const auto remove = [&](btRigidBody* sphere) {
    world->deformable().removeRigidBody(sphere);
    sphere->~btRigidBody();
  };
  btRigidBody* sphere = place(*point.position() - btVector3(0, btScalar(0.1), 0));
  auto weld = SurfaceWeld::add(world->deformable(), point, *sphere).value();
  for (int s = 0; s < 20; ++s) substep(*world);
  std::vector<unsigned char> snapshot(saveSnapshot(world->deformable(), nullptr, 0).value());
  ASSERT_TRUE(saveSnapshot(world->deformable(), snapshot.data(), snapshot.size()).ok());
  weld.reset();
  remove(sphere);
  sphere = place(btVector3(9, 6, 0));
  const Status refused = restoreSnapshot(world->deformable(), snapshot.data(), snapshot.size());
  EXPECT_EQ(refused.code, StatusCode::SnapshotMismatch) << refused.message;
  constexpr int kSteps = 60;
  for (int s = 0; s < kSteps; ++s) substep(*world);
  const btScalar fall = btScalar(10) / (240 * 240) * kSteps * (kSteps + 1) / 2;
  EXPECT_LT((sphere->getWorldTransform().getOrigin() - btVector3(9, 6 - fall, 0)).length(), btScalar(1e-4));
  EXPECT_TRUE(isFinite(body.body()));
  remove(sphere);
}

TEST(TouchLifetime, WorldsMayGoWithForcesPending) {
  auto world = deformableWorld(10);
  auto body = std::make_unique<TouchedBody>(*world);
  auto spring = SurfaceSpring::add(world->deformable(), body->vertex(5)).value();
  substep(*world);
  ASSERT_EQ(body->vertex(9).applyForce(btVector3(1, 0, 0), 100), StatusCode::Ok);
  // The world is destroyed first: this is against the rules, but nothing that is gone may be accessed.
  body->skin = {};
  world.reset();
  body.reset();
  EXPECT_EQ(spring->status(), StatusCode::BodyDeleted);
}

TEST(TouchLifetime, BodiesTakenOutOfTheWorldTakeTheirSpringsAlong) {
  auto world = deformableWorld(10);
  TouchedBody body(*world);
  auto spring = SurfaceSpring::add(world->deformable(), body.vertex(5)).value();
  ASSERT_EQ(body.vertex(9).applyForce(btVector3(1, 0, 0), 100), StatusCode::Ok);
  substep(*world);
  world->deformable().removeSoftBody(&body.body());
  EXPECT_EQ(spring->status(), StatusCode::NotInWorld);
  EXPECT_EQ(body.vertex(9).applyForce(btVector3(1, 0, 0)), StatusCode::NotInWorld);
  EXPECT_EQ(body.vertex(9).applyImpulse(btVector3(1, 0, 0)), StatusCode::Ok);
  substep(*world);
}

/// A body that hangs by a spring, and carries a box that is welded to it.
TEST(TouchLifetime, ABodyThatReturnsHangsByItsSpringAndCarriesWhatIsWeldedToIt) {
  auto world = deformableWorld(10);
  TouchedBody body(*world, TouchModel(0.38, 3));
  const int top = body.furthest(Vector3d(0, 1, 0)), bottom = body.furthest(Vector3d(0, -1, 0));
  auto spring = SurfaceSpring::add(world->deformable(), body.vertex(top)).value();
  RigidBox box(*world, 0.1, *body.vertex(bottom).position() - btVector3(0, btScalar(0.1), 0));
  auto weld = SurfaceWeld::add(world->deformable(), body.vertex(bottom), *box).value();
  box->setActivationState(DISABLE_DEACTIVATION);
  step(*world, 60);
  const auto pull = [&] { return static_cast<double>(spring->force().y()); };
  ASSERT_NEAR(pull(), 11, 3);
  body.owner->removeFromWorld();
  EXPECT_EQ(spring->status(), StatusCode::NotInWorld);
  EXPECT_EQ(weld->status(), StatusCode::NotInWorld);
  const btScalar before = box->getLinearVelocity().y();
  step(*world, 6);
  EXPECT_NEAR(box->getLinearVelocity().y() - before, -1, 0.01);  // nothing holds it
  box->setLinearVelocity(btVector3(0, 0, 0));
  box->setWorldTransform(
      btTransform(btMatrix3x3::getIdentity(), *body.vertex(bottom).position() - btVector3(0, btScalar(0.1), 0)));
  ASSERT_TRUE(body.owner->addToWorld(world->deformable()).ok());
  EXPECT_EQ(spring->status(), StatusCode::Ok);
  EXPECT_EQ(weld->status(), StatusCode::Ok);
  step(*world, 120);
  EXPECT_NEAR(pull(), 11, 3);
  EXPECT_LT(weld->separation(), 0.01);
  body.owner->removeFromWorld();
  body.owner.reset();
  step(*world, 2);
  EXPECT_EQ(spring->status(), StatusCode::BodyDeleted);
}

TEST(TouchLifetime, AnApplicationsOwnBodyIsReleasedBeforeItGoes) {
  auto world = deformableWorld(0);
  const TouchModel model(0.38, 3);
  const auto binding = model.bind();
  const SurfaceTree tree = SurfaceTree::create(binding, model.mesh).value();
  std::vector<btVector3> nodes;
  for (const Vector3d& p : model.cage.nodes) nodes.push_back(toBullet(p));
  btDeformableGravityForce gravity(btVector3(0, 0, 0));
  btDeformableNeoHookeanForce elasticity(400, 600, btScalar(0.05));
  auto body = std::make_unique<btSoftBody>(&world->deformable().getWorldInfo(), static_cast<int>(nodes.size()),
                                           nodes.data(), nullptr);
  for (const Tet& t : model.cage.tets) body->appendTetra(t[0], t[1], t[2], t[3]);
  body->initializeDmInverse();
  body->m_tetraScratches.resize(body->m_tetras.size());
  body->m_tetraScratchesTn.resize(body->m_tetras.size());
  body->setTotalMass(1, false);
  body->setActivationState(DISABLE_DEACTIVATION);
  world->deformable().addSoftBody(body.get());
  world->deformable().addForce(body.get(), &gravity);
  world->deformable().addForce(body.get(), &elasticity);
  SurfacePoint point = tree.pointAtVertex(*body, 100).value();
  ASSERT_EQ(point.applyForce(btVector3(0, 24, 0)), StatusCode::Ok);
  substep(*world);
  EXPECT_NEAR(Momentum(*body).linear.y(), 0.1, 0.002);
  auto spring = SurfaceSpring::add(world->deformable(), point).value();
  substep(*world);
  spring->release();
  point.release();
  world->deformable().removeSoftBody(body.get());
  body.reset();
  EXPECT_EQ(spring->status(), StatusCode::Released);
  EXPECT_EQ(point.status(), StatusCode::Released);
  substep(*world);
}

TEST(TouchLifetime, WhatHangsFallsAsleepAndWakesTogether) {
  auto world = deformableWorld(10);
  SoftBodyOptions held;
  held.pinned = [](const Vector3d& rest) { return rest.y() > 3.5; };
  held.stiffnessDamping = 0.1;
  TouchedBody body(*world, TouchModel(0.38, 3.0), held);
  body.body().forceActivationState(ACTIVE_TAG);
  const SurfacePoint point = body.vertex(body.furthest(-Vector3d::UnitY()));
  RigidBox box(*world, 0.05, *point.position() - btVector3(0, btScalar(0.1), 0));
  auto spring = SurfaceSpring::add(world->deformable(), point, *box, btVector3(0, btScalar(0.1), 0)).value();
  int slept = 0;
  for (; slept < 7200 && (body.body().isActive() || box->isActive()); ++slept) substep(*world);
  EXPECT_LT(slept, 7200);
  for (int s = 0; s < 240; ++s) substep(*world);
  EXPECT_FALSE(body.body().isActive());
  EXPECT_LT(spring->stretch(), 0.001);
  box->activate();
  box->applyCentralImpulse(btVector3(btScalar(0.02), 0, 0));
  for (int s = 0; s < 10; ++s) substep(*world);
  EXPECT_TRUE(body.body().isActive());
  EXPECT_LT(spring->stretch(), 0.001);
}

}  // namespace
}  // namespace tetskin::test
