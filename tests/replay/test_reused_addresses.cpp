// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Objects that are created at the addresses of others: a world's behaviour must not depend on addresses.

#include <new>

#include "solver/deformable_test.h"
#include "solver/rigid_scene.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

/// A soft block on a fixed box, which is turned about its normal; the box may be replaced by one at its address.
class BlockOnBox {
 public:
  explicit BlockOnBox(double slope) : slope_(static_cast<btScalar>(slope)) {
    SoftBodyOptions options;
    options.friction = 1;
    block = DeformableBody::add(world, smallCageAbove(0.02), oneKilogram(options)).value();
    put(0, 0);
  }
  ~BlockOnBox() { remove(); }
  /// Replaces the box by an equal one, which its own axes are turned in by a half turn.
  void replace(bool atItsAddress) {
    remove();
    put(atItsAddress ? 0 : 1, SIMD_PI);
  }
  void step(int frames) {
    for (int k = 0; k < frames; ++k) world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  }
  void remove() {
    world.removeRigidBody(box);
    box->~btRigidBody();
  }
  void put(int slot, btScalar turned) {
    box = new (memory_ + slot * kSize) btRigidBody(mass, nullptr, &shape_);
    const btQuaternion sloping(btVector3(0, 0, 1), slope_), about(btVector3(0, 1, 0), turned);
    const btVector3 below = quatRotate(sloping, btVector3(0, -1, 0));
    box->setWorldTransform(btTransform(sloping * about, below));
    box->setInterpolationWorldTransform(box->getWorldTransform());
    box->setCollisionFlags(flags);
    world.addRigidBody(box);
  }

  tetskin::DeformableWorld world;
  std::unique_ptr<DeformableBody> block;
  btRigidBody* box = nullptr;
  int flags = btCollisionObject::CF_STATIC_OBJECT;
  btScalar mass = 0;

 private:
  static constexpr std::size_t kSize = (sizeof(btRigidBody) + 63) / 64 * 64;
  btScalar slope_;
  btBoxShape shape_{btVector3(9, 1, 9)};
  alignas(64) unsigned char memory_[2 * kSize];
};

/// Runs it with the change, once at the old address and once at another one. Both must be the same to the bit.
void expectSame(const std::function<void(BlockOnBox&, bool)>& run, double slope) {
  BlockOnBox reused(slope), other(slope);
  run(reused, true);
  run(other, false);
  ASSERT_EQ(reused.block->body().isActive(), other.block->body().isActive());
  EXPECT_TRUE(saved(reused.world) == saved(other.world));
}

TEST(ReusedAddresses, FrictionDoesNotHoldOnToABoxThatIsGone) {
  for (const int frames : {1, 5}) {
    expectSame(
        [=](BlockOnBox& scene, bool atItsAddress) {
          scene.step(30);
          scene.replace(atItsAddress);
          scene.step(frames);
        },
        0.2);
  }
}

TEST(ReusedAddresses, WhatSleptOnABoxThatIsGoneWakes) {
  expectSame(
      [](BlockOnBox& scene, bool atItsAddress) {
        for (int k = 0; k < 600 && scene.block->body().isActive(); ++k) scene.step(1);
        ASSERT_FALSE(scene.block->body().isActive());
        scene.replace(atItsAddress);
        scene.step(1);
        EXPECT_TRUE(scene.block->body().isActive());
      },
      0);
}

TEST(ReusedAddresses, AKinematicBoxDoesNotGoOnAsAnotherOneWentBefore) {
  expectSame(
      [](BlockOnBox& scene, bool atItsAddress) {
        scene.flags = btCollisionObject::CF_KINEMATIC_OBJECT;
        scene.replace(false);
        const auto lift = [&](btScalar by) {
          scene.box->setWorldTransform(btTransform(scene.box->getWorldTransform().getBasis(),
                                                   scene.box->getWorldTransform().getOrigin() + btVector3(0, by, 0)));
          scene.step(1);
        };
        for (int k = 0; k < 5; ++k) lift(btScalar(0.01));
        scene.remove();
        scene.put(atItsAddress ? 1 : 0, SIMD_PI);
        for (int k = 0; k < 5; ++k) lift(btScalar(0.02));
      },
      0);
}

/// A body that is added asleep starts to observe its neighbours, whichever object was at its address before.
TEST(ReusedAddresses, ASoftBodyThatIsAddedAsleepIsANewOne) {
  bool wasReused = false;
  std::vector<int> awakeAt;
  for (const bool reuses : {true, false}) {
    tetskin::DeformableWorld world({btVector3(0, 0, 0)});
    const TetMesh cage = smallCageAbove(0);
    auto body = DeformableBody::add(world, cage).value();
    const void* const address = &body->body();
    body->body().forceActivationState(ISLAND_SLEEPING);
    for (int k = 0; k < 5; ++k) world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    const auto kept = reuses ? nullptr : std::make_unique<std::vector<char>>(1);
    std::unique_ptr<DeformableBody> next;
    if (!reuses) next = DeformableBody::add(world, cage).value();
    body.reset();
    if (reuses) next = DeformableBody::add(world, cage).value();
    wasReused |= reuses && address == &next->body();
    next->body().translate(btVector3(0, btScalar(0.5), 0));
    next->body().forceActivationState(ISLAND_SLEEPING);
    int steps = 0;
    for (; steps < 5 && !next->body().isActive(); ++steps) {
      world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    }
    awakeAt.push_back(steps);
  }
  EXPECT_EQ(awakeAt[0], awakeAt[1]) << "the address was " << (wasReused ? "" : "not ") << "used again";
}

}  // namespace
}  // namespace tetskin::test
