// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Failures while contacts are added, restored or removed leave nothing half done.
#include "contact_test.h"
#include "soft_fixtures.h"
#include "support/allocation_count.h"

#include <tetskin/replay/snapshot.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Snapshot = std::vector<unsigned char>;

Snapshot savedOf(const btDeformableMultiBodyDynamicsWorld& world) {
  Snapshot bytes(saveSnapshot(world, nullptr, 0).value());
  (void)saveSnapshot(world, bytes.data(), bytes.size()).value();
  return bytes;
}

TEST(MemoryRunsOut, WhileSurfaceContactIsAddedAndTheBodyIsAsItWas) {
  TetskinWorld world;
  const TriangleMesh mesh = ballMesh(6, 0.35);
  const auto binding = SoftBodyBinding::create(looseCage(), mesh).value();
  const auto body = added(world, looseCage());
  const Snapshot before = savedOf(world.deformable());
  std::unique_ptr<SurfaceContact> contact;
  const int failures = failEachAllocation(
      [&] { contact = SurfaceContact::add(world.deformable(), body->body(), *binding, mesh).value(); },
      [&] { ASSERT_TRUE(savedOf(world.deformable()) == before); });
  EXPECT_GT(failures, 20);
  step(world, 1);
}

TEST(MemoryRunsOut, WhileSoftContactsAreAddedAndTheListOfForcesIsAsItWas) {
  TetskinWorld world;
  const auto body = added(world, ball().cage), other = added(world, ball().at({0, 2, 0}));
  const auto& forces = *world.bodySolver().getLagrangianForceArray();
  const int count = forces.size();
  std::unique_ptr<SoftContacts> contacts;
  EXPECT_GT(failEachAllocation([&] { contacts = SoftContacts::add(world.deformable()).value(); },
                               [&] { ASSERT_EQ(forces.size(), count); }),
            1);
  ASSERT_TRUE(contacts->add(body->body(), ball().shape).ok());
  // A body that is there already stays, with its old shape.
  const std::shared_ptr<const ContactShape> coarse = ball().makeShape({100, 16});
  EXPECT_GT(failEachAllocation([&] { ASSERT_TRUE(contacts->add(body->body(), coarse).ok()); },
                               [&] { ASSERT_EQ(contacts->status(body->body()), StatusCode::Ok); }),
            1);
  ASSERT_TRUE(contacts->add(other->body(), coarse).ok());
  step(world, 1);
}

/// Two bodies of one cage with shapes of different fineness, which were swapped.
TEST(RefusedSnapshotsOfContacts, AreToldByEachBodysShape) {
  struct Scene {
    explicit Scene(bool swapped) {
      const std::shared_ptr<const ContactShape> coarse = ball().makeShape({250, 16}),
                                                fine = ball().makeShape({900, 16});
      bodies.push_back(DeformableBody::add(world, ball().at({0, 0, 0})).value());
      bodies.push_back(DeformableBody::add(world, ball().at({0, 1, 0})).value());
      EXPECT_TRUE(contacts->add(bodies[0]->body(), swapped ? fine : coarse).ok());
      EXPECT_TRUE(contacts->add(bodies[1]->body(), swapped ? coarse : fine).ok());
      for (int k = 0; k < 5; ++k) world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    }
    tetskin::DeformableWorld world;
    std::unique_ptr<SoftContacts> contacts = SoftContacts::add(world).value();
    std::vector<std::unique_ptr<DeformableBody>> bodies;
  };
  Scene one(false), other(true);
  other.world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  const Snapshot bytes = savedOf(one.world), before = savedOf(other.world);
  const Status refused = restoreSnapshot(other.world, bytes.data(), bytes.size());
  EXPECT_EQ(refused.code, StatusCode::SnapshotMismatch) << refused.message;
  EXPECT_NE(refused.message.find("another contact shape"), std::string::npos) << refused.message;
  EXPECT_TRUE(savedOf(other.world) == before);
}

/// Without a DeformableBody. Bullet would put removed bodies to sleep, which may have been destroyed.
TEST(ChangesWithinSteps, AreNoticedInAWorldOfBodiesWithContactAlone) {
  TetskinWorld world;
  const TetMesh cage = looseCage();
  const TriangleMesh mesh = ballMesh(6, 0.35);
  const auto binding = SoftBodyBinding::create(cage, mesh).value();
  const auto body = createSoftBody(cage, world.deformable().getWorldInfo(), oneKilogram()).value();
  world.deformable().addSoftBody(body.get());
  {
    const auto contact = SurfaceContact::add(world.deformable(), *body, *binding, mesh).value();
    btBoxShape shape(btVector3(1, 1, 1));
    static btRigidBody* box;
    btRigidBody removed(1, nullptr, &shape, btVector3(1, 1, 1));
    box = &removed;
    removed.setWorldTransform(placeAt(btVector3(9, 9, 9)));
    world.deformable().addRigidBody(&removed);
    removed.forceActivationState(WANTS_DEACTIVATION);
    world.deformable().setSolverCallback([](btScalar, btDeformableMultiBodyDynamicsWorld* in) {
      if (box->isInWorld()) in->removeRigidBody(box);
    });
    step(world, 1);
    world.deformable().setSolverCallback(nullptr);
    EXPECT_FALSE(removed.isInWorld());
    EXPECT_EQ(removed.getActivationState(), WANTS_DEACTIVATION);
  }
  world.deformable().removeSoftBody(body.get());
}

}  // namespace
}  // namespace tetskin::test
