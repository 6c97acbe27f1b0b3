// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world that owns its objects behaves like its parts by themselves, and releases them in any order.
#include <gtest/gtest.h>
#include <tetskin/replay/src/exported/state_hash.h>
#include <tetskin/world/world.h>

#include "support/bars.h"
#include "support/cage_surface.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

constexpr double kFrame = 1.0 / 60;

std::shared_ptr<const Cage> cubeCage() {
  return std::make_shared<Cage>(makeBox({2, 2, 2}, {0.5, 0.5, 0.5}));
}
std::shared_ptr<const TriangleMesh> surfaceOf(const Cage& cage) {
  return std::make_shared<TriangleMesh>(surfaceBeside(cage.mesh, -0.01, 1));
}
Eigen::Affine3d at(double x, double y) {
  return Eigen::Affine3d(Eigen::Translation3d(x, y, 0));
}
std::shared_ptr<btCollisionShape> ground() {
  return std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
}
btTransform moved(const btVector3& to) {
  return btTransform(btQuaternion::getIdentity(), to);
}

/// Two cubes that touch each other fall on the ground, one of them held by a spring, and a box on a hinge with a motor.
struct OwnedCrowd {
  explicit OwnedCrowd(const WorldOptions& options = {}) : world(options) {
    WorldBodyOptions soft;
    soft.softContact = true;
    floor = world.addRigidBody(ground(), 0, btTransform::getIdentity()).value();
    first = world.addBody(cage, mesh, soft, at(0, 0.3)).value();
    second = world.addBody(cage, mesh, soft, at(0.1, 0.95)).value();
    const auto shape = std::make_shared<btBoxShape>(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.1)));
    box = world.addRigidBody(shape, 1, moved({3, 2, 0})).value();
    auto hinge = std::make_unique<btHingeConstraint>(*box->body, btVector3(btScalar(-0.3), 0, 0), btVector3(0, 0, 1));
    hinge->enableAngularMotor(true, 1, 5);
    joint = world.addJoint(box, nullptr, std::move(hinge));
    const World::RayHit hit = world.raycast(btVector3(btScalar(0.1), 5, btScalar(0.1)), btVector3(0, -5, 0)).value();
    const SurfacePoint point = world.treeOf(*hit.body).value()->pointAt(hit.body->body->body(), hit.hit).value();
    World::Touch spring;
    spring.body = hit.body;
    spring.spring = SurfaceSpring::add(world.bullet(), point).value();
    touch = world.add(std::move(spring));
  }
  void run(int frames) {
    for (int frame = 0; frame < frames; ++frame) ASSERT_EQ(world.step(kFrame).value(), 4);
  }

  std::shared_ptr<const Cage> cage = cubeCage();
  std::shared_ptr<const TriangleMesh> mesh = surfaceOf(*cage);
  World world;
  std::shared_ptr<World::RigidBody> floor, box;
  std::shared_ptr<World::Body> first, second;
  std::shared_ptr<World::Joint> joint;
  std::shared_ptr<World::Touch> touch;
};

std::uint64_t hashOf(World& world) {
  return bullet_detail::stateHash(world.bullet());
}

TEST(World, HasTheBitsOfItsPartsByThemselves) {
  const auto cage = cubeCage();
  const auto mesh = surfaceOf(*cage);
  World world;
  (void)world.addRigidBody(ground(), 0, btTransform::getIdentity()).value();
  const auto body = world.addBody(cage, mesh, {}, at(0, 1)).value();

  DeformableWorld parts;
  const Rigid floor(parts, std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0,
                    btVector3(0, 0, 0));
  Cage placed = *cage;
  for (Eigen::Vector3d& node : placed.mesh.nodes) node.y() += 1.0;
  const auto part = DeformableBody::add(parts, placed).value();
  const auto binding = SoftBodyBinding::create(*cage, *mesh).value();
  SoftBodySkin skin;
  ASSERT_TRUE(skin.bind(part->body(), binding).ok());
  const auto contact = SurfaceContact::add(parts, part->body(), *binding, *mesh).value();
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_EQ(world.step(kFrame).value(), 4);
    parts.stepSimulation(btScalar(kFrame), 4, btScalar(kFrame) / 4);
    (void)skin.update();
  }
  ASSERT_EQ(body->positions.size(), 3 * skin.positions().size());
  for (std::size_t v = 0; v < skin.positions().size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(body->positions[3 * v + k], float(skin.positions()[v][k])) << v;
  }
}

TEST(World, GoesOnFromASnapshotToTheBit) {
  OwnedCrowd crowd;
  crowd.run(20);
  const std::vector<char> saved = crowd.world.save().value();
  crowd.run(20);
  const std::uint64_t hash = hashOf(crowd.world);
  const std::vector<float> positions = crowd.second->positions;
  ASSERT_TRUE(crowd.world.restore(saved.data(), saved.size()).ok());
  EXPECT_NE(hashOf(crowd.world), hash);
  crowd.run(20);
  EXPECT_EQ(hashOf(crowd.world), hash);
  EXPECT_EQ(crowd.second->positions, positions);
}

TEST(World, BodiesOfOneCageAndMeshShareTheirBinding) {
  OwnedCrowd crowd;
  EXPECT_EQ(crowd.first->binding, crowd.second->binding);
  WorldBodyOptions smooth;
  smooth.binding.interpolation = Interpolation::Quadratic;
  EXPECT_NE(crowd.world.addBody(crowd.cage, crowd.mesh, smooth, at(5, 5)).value()->binding, crowd.first->binding);
  WorldBodyOptions hard;
  hard.binding.hardEdgeDegrees = 10;
  EXPECT_NE(crowd.world.addBody(crowd.cage, crowd.mesh, hard, at(5, 8)).value()->binding, crowd.first->binding);
  WorldBodyOptions sorted;
  sorted.binding.order = VertexOrder::Sorted;
  EXPECT_NE(crowd.world.addBody(crowd.cage, crowd.mesh, sorted, at(5, 11)).value()->binding, crowd.first->binding);
}

TEST(World, AJointMayBeRemovedWithinAStep) {
  OwnedCrowd crowd;
  const auto inside = [&](btScalar whole, int count, btScalar substep) {
    const int made = crowd.world.bullet().stepSimulation(whole, count, substep);
    crowd.world.remove(*crowd.joint);
    return made;
  };
  EXPECT_EQ(crowd.world.step(kFrame, 4, inside).value(), 4);
  EXPECT_FALSE(crowd.joint->joint);
  crowd.run(1);
}

TEST(World, WhatIsRemovedTakesAlongWhatIsAttachedToIt) {
  OwnedCrowd crowd;
  crowd.run(2);
  const std::shared_ptr<World::Body> held = crowd.touch->body;
  crowd.world.remove(*held);
  EXPECT_TRUE(held->removed);
  EXPECT_FALSE(crowd.touch->spring);
  crowd.world.remove(*crowd.box);
  EXPECT_FALSE(crowd.joint->joint);
  EXPECT_EQ(crowd.world.bodies().size(), 1u);
  EXPECT_EQ(crowd.world.rigidBodies().size(), 1u);
  crowd.world.remove(*held);
  crowd.world.remove(*crowd.box);
  crowd.world.remove(*crowd.touch);
  crowd.world.setPose(*crowd.box, moved({0, 9, 0}));
  EXPECT_EQ(crowd.world.teleport(*held, moved({0, 9, 0})).code, StatusCode::BodyDeleted);
  EXPECT_EQ(crowd.world.treeOf(*held).status().code, StatusCode::BodyDeleted);
  crowd.run(2);
}

TEST(World, ThingsOutliveIt) {
  std::shared_ptr<World::Body> body;
  std::shared_ptr<World::Joint> joint;
  std::shared_ptr<World::RigidBody> box;
  {
    OwnedCrowd crowd;
    crowd.run(1);
    body = crowd.first;
    joint = crowd.joint;
    box = crowd.box;
  }
  EXPECT_TRUE(body->removed && box->removed && !joint->joint);
  EXPECT_EQ(body->positions.size(), 3 * body->mesh->vertexCount());
  EXPECT_TRUE(std::isfinite(body->positions[0]));
}

TEST(World, ABodyThatIsRefusedLeavesNothing) {
  OwnedCrowd crowd;
  const std::uint64_t hash = hashOf(crowd.world);
  WorldBodyOptions options;
  options.softContact = true;
  EXPECT_EQ(crowd.world.addBody(crowd.cage, nullptr, options).status().code, StatusCode::Unbound);
  options.pinned = {3, 1000};
  EXPECT_EQ(crowd.world.addBody(crowd.cage, crowd.mesh, options).status().code, StatusCode::IndexOutOfRange);
  options.pinned = {};
  const std::vector<char> saved = crowd.world.save().value();
  const auto refused = [&] {
    EXPECT_EQ(crowd.world.addBody(crowd.cage, crowd.mesh, options).status().code, StatusCode::InvalidOption);
    EXPECT_EQ(crowd.world.save().value(), saved);
  };
  options.binding.hardEdgeDegrees = -1;
  refused();
  options.binding = {};
  options.contactMargin = -1;
  refused();
  options.contactMargin = {};
  for (const double spacing : {-1.0, 0.0, std::nan(""), 1e-9}) {
    options.sampleSpacing = spacing;
    refused();
  }
  const btTransform here = btTransform::getIdentity();
  EXPECT_EQ(crowd.world.addRigidBody(ground(), 1, here).status().code, StatusCode::InvalidOption);
  EXPECT_EQ(crowd.world.addRigidBody(ground(), 0, here, -1).status().code, StatusCode::InvalidOption);
  EXPECT_EQ(crowd.world.addRigidBody(std::make_shared<btSphereShape>(btScalar(1)), 1, here, 0.5, true).status().code,
            StatusCode::InvalidOption);
  EXPECT_EQ(hashOf(crowd.world), hash);
  EXPECT_EQ(crowd.world.bodies().size(), 2u);
}

TEST(World, AStepOutOfRangeOrWithinAStepIsRefused) {
  OwnedCrowd crowd;
  const std::uint64_t hash = hashOf(crowd.world);
  for (const double dt : {-1.0, 1e-9, 11.0, HUGE_VAL, std::nan("")})
    EXPECT_EQ(crowd.world.step(dt).status().message.rfind("dt: must be 0, or from 1e-6", 0), 0u) << dt;
  EXPECT_EQ(crowd.world.step(kFrame, 0).status().message.rfind("substeps: must be from 1", 0), 0u);
  EXPECT_EQ(crowd.world.step(0.0).value(), 0);
  EXPECT_EQ(hashOf(crowd.world), hash);
  int refused = 0;
  const auto inside = [&](btScalar whole, int count, btScalar substep) {
    refused += crowd.world.inStep() && !crowd.world.step(kFrame).ok() && !crowd.world.restore(nullptr, 0).ok();
    return crowd.world.bullet().stepSimulation(whole, count, substep);
  };
  EXPECT_EQ(crowd.world.step(kFrame, 3, inside).value(), 3);
  EXPECT_EQ(refused, 1);
  EXPECT_FALSE(crowd.world.inStep());
}

TEST(World, SaysThatABodyHasExplodedAfterTheStep) {
  OwnedCrowd crowd;
  for (int k = 0; k < 2; ++k) ASSERT_TRUE(crowd.world.teleport(*crowd.second, moved({btScalar(1e18), 0, 0})).ok());
  const Status status = crowd.world.step(kFrame).status();
  EXPECT_EQ(status.code, StatusCode::NonFinite);
  EXPECT_EQ(status.message.rfind("body 1 has nodes that are not finite", 0), 0u);
  crowd.world.remove(*crowd.second);
  EXPECT_TRUE(crowd.world.step(kFrame).ok());
}

TEST(World, MotorsAreLimitedByTorquesBetweenSteps) {
  OwnedCrowd crowd;
  const auto& hinge = static_cast<const btHingeConstraint&>(*crowd.joint->joint);
  EXPECT_EQ(const_cast<btHingeConstraint&>(hinge).getMaxMotorImpulse(), btScalar(5));
  crowd.run(3);
  EXPECT_EQ(const_cast<btHingeConstraint&>(hinge).getMaxMotorImpulse(), btScalar(5));
}

}  // namespace
}  // namespace tetskin::test
