// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/motion/sleepers.h>
#include <tetskin/solver/src/motion/stillness.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <utility>

#include "deformable_test.h"

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr int kStepsAsleep = 5;

/// A sleeping body, an obstacle beside it and one far away, in a world that is not stepped.
class SleepingBody : public testing::Test {
 protected:
  SleepingBody() {
    body = createSoftBody(smallCageAbove(5), world.deformable().getWorldInfo()).value();
    world.deformable().addSoftBody(body.get());
    for (btRigidBody* obstacle : {&platform, &stranger}) world.deformable().addRigidBody(obstacle);
    place(platform, btVector3(0, btScalar(4.2), 0));
    place(stranger, btVector3(20, 5, 0));
    body->forceActivationState(ISLAND_SLEEPING);
    all.push_back(body.get());
  }
  ~SleepingBody() override {
    for (btRigidBody* obstacle : {&platform, &stranger}) world.deformable().removeRigidBody(obstacle);
    world.deformable().removeSoftBody(body.get());
  }

  void place(btRigidBody& obstacle, const btVector3& at) {
    obstacle.setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
  }
  /// Returns true if the body is awake after this many steps.
  bool wakes(int steps) {
    for (int step = 0; step < steps; ++step) {
      world.deformable().performDiscreteCollisionDetection();
      sleepers.wake(all);
    }
    return body->isActive();
  }
  /// True if the body sleeps, but no longer after the change.
  bool isWokenBy(const std::function<void()>& change) {
    body->forceActivationState(ACTIVE_TAG);
    wakes(1);
    body->forceActivationState(ISLAND_SLEEPING);
    if (wakes(kStepsAsleep)) return false;
    change();
    return wakes(1);
  }

  TetskinWorld world;
  btBoxShape shape{btVector3(1, 1, 1)}, otherShape{btVector3(1, 1, 1)};
  btRigidBody platform{0, nullptr, &shape}, stranger{0, nullptr, &shape};
  std::unique_ptr<btSoftBody> body;
  btAlignedObjectArray<btSoftBody*> all;
  Sleepers sleepers;
};

TEST_F(SleepingBody, SleepsOnWhereNothingNearItChanges) {
  EXPECT_FALSE(wakes(20));
  EXPECT_FALSE(isWokenBy([&] { place(stranger, btVector3(30, 5, 0)); }));
  EXPECT_FALSE(isWokenBy([&] { stranger.setFriction(btScalar(0.1)); }));
}

TEST_F(SleepingBody, IsWokenByChangesOfItself) {
  btSoftBody::Node& node = body->m_nodes[5];
  EXPECT_TRUE(isWokenBy([&] { node.m_x.setZ(node.m_x.z() + btScalar(1e-5)); }));
  EXPECT_TRUE(isWokenBy([&] { std::swap(node.m_x, body->m_nodes[6].m_x); }));
  EXPECT_TRUE(isWokenBy([&] {
    for (const int n : {5, 6}) body->m_nodes[n].m_x.setY(-body->m_nodes[n].m_x.y());
  })) << "signs";
  EXPECT_TRUE(isWokenBy([&] { node.m_im /= 2; }));
  EXPECT_TRUE(isWokenBy([&] { body->m_cfg.kDF /= 2; }));
  EXPECT_TRUE(isWokenBy([&] { node.m_v.setX(btScalar(0.1)); }));
}

TEST_F(SleepingBody, IsWokenByChangesOfWhatItLiesOn) {
  EXPECT_TRUE(isWokenBy([&] { place(platform, btVector3(0, btScalar(4.19), 0)); }));
  EXPECT_TRUE(isWokenBy([&] { place(platform, btVector3(-9, 4, 0)); })) << "away";
  place(platform, btVector3(0, btScalar(4.2), 0));
  EXPECT_TRUE(isWokenBy([&] { platform.setFriction(btScalar(0.1)); }));
  EXPECT_TRUE(isWokenBy([&] { platform.setCollisionShape(&otherShape); }));
  EXPECT_TRUE(isWokenBy([&] { otherShape.setLocalScaling(btVector3(1, btScalar(0.95), 1)); }));
  EXPECT_TRUE(isWokenBy([&] { body->setIgnoreCollisionCheck(&platform, true); }));
  body->setIgnoreCollisionCheck(&platform, false);
  EXPECT_TRUE(isWokenBy([&] { world.deformable().removeRigidBody(&platform); }));
}

TEST_F(SleepingBody, IsWokenByAnObstacleThatReachesIt) {
  EXPECT_TRUE(isWokenBy([&] { place(stranger, btVector3(0, btScalar(6.5), 0)); }));
}

TEST_F(SleepingBody, IsWokenByTheHookItIsAnchoredTo) {
  body->appendDeformableAnchor(0, &stranger);
  EXPECT_TRUE(isWokenBy([&] { place(stranger, btVector3(20, btScalar(5.1), 0)); }));
}

TEST_F(SleepingBody, IsWokenByWhatChangesBetweenFallingAsleepAndTheNextStep) {
  for (const bool stored : {false, true}) {
    body->forceActivationState(ACTIVE_TAG);
    EXPECT_TRUE(wakes(1));
    if (stored) sleepers.store(*body);
    body->forceActivationState(ISLAND_SLEEPING);
    body->m_cfg.kDF /= 2;
    EXPECT_EQ(wakes(1), stored);
  }
}

/// A body for which Bullet has counted five seconds of stillness.
class StillBody : public testing::Test {
 protected:
  void SetUp() override {
    btAlignedObjectArray<btSoftBody*> listed, awake;
    world.deformable().setGravity(btVector3(0, -10, 0));
    listed.push_back(&made->body());
    bodies.collect(listed, false, awake);
    bodies.assign(*world.bodySolver().getLagrangianForceArray());
  }
  /// The time for which it has been still, as the next step takes it.
  btScalar judged(Stillness& by) {
    made->body().setDeactivationTime(5);
    made->body().m_maxSpeedSquared = 0;
    by.judge(bodies, rigids, btScalar(1) / 60);
    return made->body().getDeactivationTime();
  }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> made = added(world, smallCageAbove(5));
  SolverBodies bodies;
  RigidUnknowns rigids;
  Stillness stillness;
};

TEST_F(StillBody, WaitsAnewOnceItHasMovedByAboutAFortiethOfItsSizeTimesTheThreshold) {
  const btScalar allowed = btScalar(0.025) * made->body().m_sleepingThreshold * sizeOf(made->body());
  EXPECT_EQ(judged(stillness), 5);
  const std::pair<double, btScalar> moves[] = {{0.3, 5}, {0.2, 5}, {0.6, 0}, {0.5, 5}, {0.6, 0}};
  for (const auto& [way, time] : moves) {
    made->body().translate(btVector3(0, static_cast<btScalar>(way) * allowed, 0));
    EXPECT_EQ(judged(stillness), time) << way;
  }
}

TEST_F(StillBody, OfASnapshotGoesOnWithTheMeanOfItsVelocity) {
  made->body().setVelocity(btVector3(btScalar(0.005), 0, 0));
  EXPECT_LT(judged(stillness), 5) << "it has just begun to move so";
  for (int step = 0; step < 100; ++step) judged(stillness);
  EXPECT_EQ(judged(stillness), 5);
  unsigned char bytes[1000];
  WorldStream out(world.deformable(), bytes, sizeof bytes);
  stillness.serialize(out);
  Stillness restored;
  WorldStream in(world.deformable(), static_cast<const unsigned char*>(bytes), sizeof bytes);
  restored.serialize(in);
  EXPECT_EQ(judged(restored), 5);
}

}  // namespace
}  // namespace tetskin::test
