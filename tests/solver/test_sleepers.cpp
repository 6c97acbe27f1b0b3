// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/motion/sleepers.h>
#include <tetskin/solver/src/motion/stillness.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <functional>
#include <utility>
#include <vector>

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

/// A body that stands still by itself, and is judged as by steps.
class StillBody : public testing::Test {
 protected:
  void SetUp() override {
    btAlignedObjectArray<btSoftBody*> listed, awake;
    world.deformable().setGravity(btVector3(0, -10, 0));
    body().updateBounds();
    listed.push_back(&body());
    bodies.collect(listed, false, awake);
    bodies.assign(*world.bodySolver().getLagrangianForceArray());
  }
  btSoftBody& body() { return made->body(); }
  /// The seconds after which it rests, from now on; 5 if it does not before.
  double restsAfter(
      Stillness& by, const std::function<void(int)>& before = [](int) {}) {
    body().setActivationState(ACTIVE_TAG);
    for (int step = 0; step < 300; ++step) {
      if (body().getActivationState() == WANTS_DEACTIVATION) return step / 60.0;
      before(step);
      body().m_maxSpeedSquared = 0;
      by.judge(bodies, rigids, btScalar(1) / 60);
      body().updateDeactivation(btScalar(1) / 60);
    }
    return 5;
  }
  /// Moved so fast for some steps, or to and fro.
  double restsAfterMoving(double sizesPerSecond, bool turns = false, int steps = 300) {
    Stillness by;
    const btScalar step = static_cast<btScalar>(sizesPerSecond / 60.0) * sizeOf(body());
    return restsAfter(by, [=](int k) {
      if (k < steps) body().translate(btVector3(0, turns && k % 20 >= 10 ? -step : step, 0));
    });
  }

  std::vector<unsigned char> saved(Stillness& by) {
    std::vector<unsigned char> bytes(6000);
    WorldStream out(world.deformable(), bytes.data(), bytes.size());
    by.serialize(out);
    return bytes;
  }
  void restore(const std::vector<unsigned char>& bytes, Stillness& to) {
    WorldStream in(world.deformable(), bytes.data(), bytes.size());
    to.serialize(in);
  }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> made = added(world, smallCageAbove(5));
  SolverBodies bodies;
  RigidUnknowns rigids;
  Stillness stillness;
};

TEST_F(StillBody, RestsAfterTheTimeThatItMustWait) {
  EXPECT_NEAR(restsAfter(stillness), 0.5, 0.04);
  Stillness patient;
  patient.sleepAfter = 2;
  EXPECT_NEAR(restsAfter(patient), 2.0, 0.04);
  Stillness woken;
  EXPECT_NEAR(restsAfter(woken,
                         [&](int step) {
                           if (step == 20) body().activate();
                         }),
              0.85, 0.04);
}

TEST_F(StillBody, DriftsByLessThanAboutAFortiethOfAPercentOfItsSize) {
  EXPECT_LT(restsAfterMoving(4e-4), 0.6);
  EXPECT_EQ(restsAfterMoving(6e-4), 5.0);
  EXPECT_NEAR(restsAfterMoving(6e-4, false, 60), 1.5, 0.5) << "it has stopped";
}

TEST_F(StillBody, MaySwayByAPercentIfSomethingHoldsIt) {
  EXPECT_EQ(restsAfterMoving(0.03, true), 5.0) << "nothing does";
  ASSERT_TRUE(made->setPinned(0).ok());
  EXPECT_LT(restsAfterMoving(0.03, true), 1.1);
  EXPECT_EQ(restsAfterMoving(0.15, true), 5.0) << "too far";
  EXPECT_EQ(restsAfterMoving(0.01), 5.0) << "it does not come back";
}

TEST_F(StillBody, OfASnapshotGoesOnWaiting) {
  stillness.sleepAfter = 1;
  std::vector<unsigned char> snapshot;
  const double after = restsAfter(stillness, [&](int step) {
    if (step == 20) snapshot = saved(stillness);
  });
  Stillness restored;
  restore(snapshot, restored);
  EXPECT_EQ(restored.sleepAfter, 1);
  EXPECT_NEAR(restsAfter(restored), after - 20 / 60.0, 0.001);
}

TEST_F(StillBody, OfASnapshotGoesOnWithTheMeanOfItsVelocity) {
  body().setVelocity(btVector3(0, btScalar(0.005), 0));
  EXPECT_GT(restsAfter(stillness), 0.6) << "it has just begun to move so";
  Stillness restored;
  restore(saved(stillness), restored);
  EXPECT_LT(restsAfter(restored), 0.03);
}

}  // namespace
}  // namespace tetskin::test
