// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Forces between bodies in contact at their surfaces, as ForceRecord reports them.
#include "contact_test.h"
#include "soft_fixtures.h"
#include "solver/recorded_forces.h"
#include "support/allocation_count.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

SoftBodyOptions stiff() {
  SoftBodyOptions options;
  options.relativeStiffness = 1000;
  options.friction = 1;
  return options;
}

btVector3 weightOf(double bodies) {
  return btVector3(0, static_cast<btScalar>(-kWeight * bodies), 0);
}

TEST(ContactForces, AtRestTheSumIsTheWeight) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.36), 0));
  body.body->body().setActivationState(DISABLE_DEACTIVATION);
  const auto forces = forcesIn(world);
  step(world, 300);
  const AppliedForces onFloor = forces->forcesOn(floorOf(world));
  expectNear(onFloor.total().force, weightOf(1), 1e-3 * kWeight);
  expectNear(onFloor.contact.force, weightOf(1), 1e-3 * kWeight);
  expectNear(forces->forcesOn(body.body->body()).total().force, -weightOf(1), 1e-3 * kWeight);
}

/// Two kinematic plates close on a box in the air.
TEST(ContactForces, AGripperHoldsByFriction) {
  TetskinWorld world;
  TouchingBody held(world, boxMesh(Vector3d(0.35, 0.35, 0.35)), btVector3(0, 3, 0), {}, stiff());
  held.body->body().setActivationState(DISABLE_DEACTIVATION);
  const auto plate = [] { return std::make_unique<btBoxShape>(btVector3(btScalar(0.2), 1, 1)); };
  const auto at = [](btScalar x) { return placeAt(btVector3(x, 3, 0)); };
  const btScalar open = btScalar(0.55), closed = btScalar(0.53);
  Obstacle left(world, plate(), at(-open)), right(world, plate(), at(open));
  for (Obstacle* finger : {&left, &right}) {
    finger->body().setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    finger->body().setActivationState(DISABLE_DEACTIVATION);
  }
  const auto forces = forcesIn(world);
  for (int f = 1; f <= 240; ++f) {
    const btScalar x = open + (closed - open) * std::min(btScalar(f) / 6, btScalar(1));
    left.body().setWorldTransform(at(-x));
    right.body().setWorldTransform(at(x));
    step(world, 1);
  }
  const btSoftBody& soft = held.body->body();
  const AppliedForces onLeft = forces->forcesBetween(left.body(), soft),
                      onRight = forces->forcesBetween(right.body(), soft);
  EXPECT_NEAR(onLeft.friction.force.y() + onRight.friction.force.y(), -kWeight, 1e-3 * kWeight);
  EXPECT_NEAR(onLeft.friction.force.y(), -kWeight / 2, 0.02 * kWeight);
  EXPECT_NEAR(onLeft.contact.force.x() + onRight.contact.force.x(), 0, 1e-3 * kWeight);
  EXPECT_LT(onLeft.contact.force.x(), -kWeight);
  EXPECT_NEAR(onLeft.contact.force.y(), 0, 1e-3 * kWeight);
  EXPECT_GT(held.height(), 2.6);
}

TEST(ContactForces, ARigidBodyFeelsWhatChangesItsMomentum) {
  TetskinWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  Obstacle target(world, std::make_unique<btSphereShape>(btScalar(0.3)),
                  placeAt(btVector3(btScalar(0.1), 3, btScalar(0.05))), 2);
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(3.9), 0));
  body.body->body().setVelocity(btVector3(0, -3, 0));
  const auto forces = forcesIn(world);
  btScalar pushed = 0;
  for (int f = 0; f < 40; ++f) {
    const btVector3 linear = target.body().getLinearVelocity(), angular = target.body().getAngularVelocity();
    const btVector3 before = momentumOf(body.body->body());
    step(world, 1);
    const Wrench on = forces->forcesOn(target.body()).total();
    expectNear(on.force / 60, 2 * (target.body().getLinearVelocity() - linear), 2e-5);
    expectNear(on.torque / 60, target.body().getLocalInertia() * (target.body().getAngularVelocity() - angular), 2e-5);
    expectNear(-on.force / 60, momentumOf(body.body->body()) - before, 1e-4);
    pushed += on.force.length() / 60;
  }
  EXPECT_GT(pushed, 1);
}

TEST(ContactForces, ALinkFeelsWhatChangesItsMomentum) {
  TetskinWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  const FlatMultibody multi(world, 1, btVector3(0, 3, 0));
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(3.7), 0));
  body.body->body().setVelocity(btVector3(0, -2, 0));
  const auto forces = forcesIn(world);
  for (int f = 0; f < 30; ++f) {
    const btVector3 before = multi.body.getBaseVel();
    step(world, 1);
    expectNear(forces->forcesOn(multi.link).total().force / 60, multi.body.getBaseVel() - before, 1e-4);
  }
  EXPECT_LT(multi.body.getBaseVel().y(), -0.3);
}

// ---- soft bodies

struct Balls {
  explicit Balls(const btVector3& gravity) : world(worldWith(gravity)), contacts(contactsIn(*world)) {}
  btSoftBody& add(const Vector3d& at) {
    SoftBodyOptions options;
    options.youngsModulus = 2000.0;
    options.margin = 0.002;
    bodies.push_back(added(*world, ball().at(at), options));
    EXPECT_TRUE(contacts->add(bodies.back()->body(), ball().shape).ok());
    return bodies.back()->body();
  }

  std::unique_ptr<TetskinWorld> world;
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::unique_ptr<SoftContacts> contacts;
};

TEST(ContactForces, OfAPairAreTheChangeOfMomentumOfEach) {
  Balls balls(btVector3(0, 0, 0));
  btSoftBody &a = balls.add(Vector3d(0, 2, 0)), &b = balls.add(Vector3d(1.0, 2.1, 0.2));
  a.setVelocity(btVector3(2, 0, 0));
  const auto forces = forcesIn(*balls.world);
  btScalar pushed = 0;
  for (int f = 0; f < 40; ++f) {
    const btVector3 before[] = {momentumOf(a), momentumOf(b)};
    const btVector3 centres[] = {centreOf(a), centreOf(b)};
    step(*balls.world, 1);
    const Wrench onA = forces->forcesBetween(a, b).total(), onB = forces->forcesBetween(b, a).total();
    EXPECT_EQ(onA.force, -onB.force);
    EXPECT_EQ(forces->forcesOn(a).total().force, onA.force);
    expectNear(onA.force / 60, momentumOf(a) - before[0], 1e-4);
    expectNear(onB.force / 60, momentumOf(b) - before[1], 1e-4);
    // About one point: both forces act at the same position, except for the gap or penetration between the bodies.
    const btVector3 torque = onA.torque + onB.torque + (centres[0] - centres[1]).cross(onA.force);
    EXPECT_LT(torque.length(), 0.05 * static_cast<double>(onA.force.length()) + 1e-4);
    pushed += onA.force.length() / 60;
  }
  EXPECT_GT(pushed, 1);
  step(*balls.world, 60);
  EXPECT_TRUE(isNothing(forces->forcesOn(a)));
}

TEST(ContactForces, OfABodyOnAnotherAreItsWeight) {
  Balls balls(btVector3(0, -10, 0));
  const auto addPlate = [&](double height, const SoftBodyOptions& options) {
    TetMesh cage = plate().cage;
    for (Vector3d& p : cage.nodes) p.y() += height;
    auto made = added(*balls.world, cage, options);
    EXPECT_TRUE(balls.contacts->add(made->body(), plate().shape).ok());
    made->body().setActivationState(DISABLE_DEACTIVATION);
    return made;
  };
  SoftBodyOptions held = stiff();
  held.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
  const auto below = addPlate(1, held), above = addPlate(1.13, stiff());
  const auto forces = forcesIn(*balls.world);
  step(*balls.world, 240);
  expectNear(forces->forcesBetween(below->body(), above->body()).total().force, weightOf(1), 1e-3 * kWeight);
  expectNear(forces->forcesOn(above->body()).total().force, -weightOf(1), 1e-3 * kWeight);
}

// ---- events that do not change them, and events that end them

TEST(ContactForces, AndContactsAreToldWithoutAllocation) {
  Balls balls(btVector3(0, -10, 0));
  btSoftBody &a = balls.add(Vector3d(3, 1, 0)), &b = balls.add(Vector3d(3, 1.83, 0));
  b.setVelocity(btVector3(0, -3, 0));
  TouchingBody body(*balls.world, ballMesh(24, 0.35), btVector3(0, btScalar(0.352), 0));
  const auto forces = forcesIn(*balls.world);
  step(*balls.world, 1);
  ASSERT_FALSE(body.contact->contacts().empty());
  ASSERT_FALSE(balls.contacts->contacts().empty());
  // All arrays have grown to the size they need.
  const std::size_t before = allocationCount();
  const std::size_t told = body.contact->contacts().size() + balls.contacts->contacts().size();
  const btScalar onB = forces->forcesBetween(b, a).total().force.length();
  const btScalar onFloor = forces->forcesOn(floorOf(*balls.world)).total().force.length();
  EXPECT_EQ(allocationCount(), before);
  EXPECT_GT(told, 1U);
  EXPECT_GT(onB, 0);
  EXPECT_GT(onFloor, 0);
}

}  // namespace
}  // namespace tetskin::test
