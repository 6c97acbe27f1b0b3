// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Snapshots of worlds of rigid bodies, joints and multibodies: the restored world goes on to the last bit, and so do
// the bytes of later snapshots.
#include "saved.h"
#include "solver/rigid_scene.h"

#include <gtest/gtest.h>
#include <tetskin/replay/snapshot.h>

#include <functional>
#include <string>

namespace tetskin::test {
namespace {

struct Kind {
  const char* name;
  std::function<void(RigidScene&)> build;
};
void PrintTo(const Kind& kind, std::ostream* out) {  // not byte by byte: some of it is addresses
  *out << kind.name;
}

void buildAll(RigidScene& scene) {
  scene.addKinds();
  scene.addStack(20);
  scene.addJoints();
  scene.addArm();
}

class SnapshotsOfRigidBodies : public testing::TestWithParam<Kind> {
 protected:
  static void build(RigidScene& scene) {
    scene.addFloor();
    GetParam().build(scene);
  }
  /// The application moves its kinematic plates.
  static void step(RigidScene& scene, int frame) {
    for (const auto& body : scene.bodies) {
      if (!body->isKinematicObject()) continue;
      btTransform at = body->getWorldTransform();
      at.getOrigin().setX(-3 + btScalar(0.3) * btSin(btScalar(0.05) * btScalar(frame)));
      body->setWorldTransform(at);
    }
    scene.step();
  }

  struct Run {
    int start = 0;
    Snapshot snapshot;
    std::vector<std::vector<btScalar>> motion;  ///< of each frame after it
    std::vector<Snapshot> snapshots;
  };
  static Run run(RigidScene& scene, int& frame, int frames) {
    Run run;
    run.start = frame;
    run.snapshot = saved(scene.world);
    EXPECT_EQ(saved(scene.world), run.snapshot) << "saving has changed the world";
    for (int k = 0; k < frames; ++k) {
      step(scene, frame++);
      run.motion.push_back(scene.motion());
      run.snapshots.push_back(saved(scene.world));
    }
    return run;
  }
  static void expectGoesOnAs(const Run& run, RigidScene& scene) {
    const Status status = restoreSnapshot(scene.world, run.snapshot.data(), run.snapshot.size());
    ASSERT_TRUE(status.ok()) << status.message;
    ASSERT_EQ(saved(scene.world), run.snapshot);
    for (std::size_t k = 0; k < run.motion.size(); ++k) {
      step(scene, run.start + static_cast<int>(k));
      ASSERT_EQ(scene.motion(), run.motion[k]) << "frame " << k << " after " << run.start;
      ASSERT_EQ(saved(scene.world), run.snapshots[k]) << "frame " << k << " after " << run.start;
    }
  }
};

TEST_P(SnapshotsOfRigidBodies, GoOnAsBefore) {
  RigidScene scene;
  build(scene);
  int frame = 0;
  for (const int pause : {0, 1, 30, 150}) {
    while (frame < pause) step(scene, frame++);
    const Run before = run(scene, frame, 25);
    expectGoesOnAs(before, scene);
    for (int k = 0; k < 7; ++k) step(scene, frame + k);
    expectGoesOnAs(before, scene);
  }
}

TEST_P(SnapshotsOfRigidBodies, GoOnInAnotherWorldBuiltInTheSameOrder) {
  RigidScene scene;
  build(scene);
  int frame = 0;
  while (frame < 60) step(scene, frame++);
  const Run before = run(scene, frame, 60);
  RigidScene fresh;
  build(fresh);
  expectGoesOnAs(before, fresh);
  RigidScene churned;
  auto& ball = churned.shape<btSphereShape>(btScalar(1));
  for (const int height : {0, 1, 3}) churned.add(ball, 1, btVector3(0, btScalar(height), 0));
  churned.step(3);
  while (!churned.bodies.empty()) churned.remove(*churned.bodies.front());
  build(churned);
  churned.step(2);
  expectGoesOnAs(before, churned);
}

TEST_P(SnapshotsOfRigidBodies, GoOnAfterOtherBodiesHaveComeAndGone) {
  RigidScene scene;
  auto& ball = scene.shape<btSphereShape>(btScalar(0.3));
  scene.add(ball, 1, btVector3(0, 9, 0));
  scene.add(ball, 1, btVector3(1, 9, 0));
  build(scene);
  scene.remove(*scene.bodies.front());  // the last one takes its place in Bullet's lists
  int frame = 0;
  while (frame < 30) step(scene, frame++);
  const Run before = run(scene, frame, 40);
  btRigidBody& guest = scene.add(ball, 5, btVector3(btScalar(0.3), 2, 0));
  btRigidBody& second = scene.add(ball, 5, btVector3(4, 4, 0));
  for (int k = 0; k < 20; ++k) step(scene, k);
  scene.remove(guest);
  for (int k = 0; k < 5; ++k) step(scene, k);
  scene.remove(second);
  expectGoesOnAs(before, scene);
}

INSTANTIATE_TEST_SUITE_P(, SnapshotsOfRigidBodies,
                         testing::Values(Kind{"stack", [](RigidScene& s) { s.addStack(60); }}, Kind{"all", buildAll}),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(SnapshotsOfRigidWorlds, OfAnEmptyWorldChangeNothing) {
  tetskin::DeformableWorld world;
  const Snapshot snapshot = saved(world);
  EXPECT_TRUE(restoreSnapshot(world, snapshot.data(), snapshot.size()).ok());
  EXPECT_EQ(saved(world), snapshot);
}

TEST(SnapshotsOfRigidWorlds, PutBackWhatTheApplicationHasChanged) {
  RigidScene scene;
  scene.addFloor();
  scene.addStack(10);
  scene.addJoints();
  scene.addArm();
  scene.step(20);
  const Snapshot snapshot = saved(scene.world);
  scene.step(40);
  const std::vector<btScalar> later = scene.motion();
  ASSERT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
  btRigidBody& body = *scene.bodies[5];
  body.setMassProps(7, btVector3(1, 2, 3));
  body.setFriction(0);
  body.setDamping(btScalar(0.5), btScalar(0.5));
  body.setGravity(btVector3(1, 1, 1));
  body.setIgnoreCollisionCheck(scene.bodies[6].get(), true);
  body.applyCentralImpulse(btVector3(3, 0, 0));
  scene.bodies[7]->forceActivationState(DISABLE_SIMULATION);
  scene.world.setGravity(btVector3(2, 3, 4));
  scene.world.getSolverInfo().m_numIterations = 3;
  for (auto& joint : scene.joints) joint->setEnabled(false);
  static_cast<btHingeConstraint&>(*scene.joints[2]).setMotorTargetVelocity(-9);
  static_cast<btPoint2PointConstraint&>(*scene.joints[0]).setPivotA(btVector3(0, 1, 0));
  scene.motor->setVelocityTarget(-4);
  scene.multibodies[0]->addJointTorque(0, 30);
  scene.multibodies[0]->setLinearDamping(btScalar(0.9));
  scene.step(3);
  ASSERT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
  EXPECT_EQ(saved(scene.world), snapshot);
  scene.step(40);
  EXPECT_EQ(scene.motion(), later);
}

TEST(SnapshotsOfRigidWorlds, TellMotionStates) {
  RigidScene scene;
  scene.addFloor();
  scene.addStack(1);
  btDefaultMotionState state;
  scene.bodies[1]->setMotionState(&state);
  scene.step(3);
  const Snapshot snapshot = saved(scene.world);
  const btVector3 before = state.m_graphicsWorldTrans.getOrigin();
  scene.step(30);
  ASSERT_NE(state.m_graphicsWorldTrans.getOrigin(), before);
  ASSERT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
  EXPECT_EQ(state.m_graphicsWorldTrans.getOrigin(), before);
}

TEST(SnapshotsOfRigidWorlds, NeedABufferOfTheirSize) {
  RigidScene scene;
  scene.addFloor();
  scene.addStack(3);
  scene.step();
  const std::size_t size = saveSnapshot(scene.world, nullptr, 0).value();
  for (const std::size_t given : {std::size_t{0}, std::size_t{1}, std::size_t{100}, size - 1}) {
    std::vector<unsigned char> buffer(given + 1, 0xAB);
    const Result<std::size_t> result = saveSnapshot(scene.world, buffer.data(), given);
    EXPECT_EQ(result.status().code, StatusCode::SizeMismatch);
    EXPECT_NE(result.status().message.find(std::to_string(given)), std::string::npos);
    EXPECT_NE(result.status().message.find(std::to_string(size)), std::string::npos);
    EXPECT_EQ(buffer.back(), 0xAB);
  }
  std::vector<unsigned char> buffer(size + 9, 0xAB);
  EXPECT_EQ(saveSnapshot(scene.world, buffer.data() + 1, buffer.size() - 1).value(), size);  // not aligned
  EXPECT_EQ(buffer[size + 1], 0xAB);
  EXPECT_TRUE(restoreSnapshot(scene.world, buffer.data() + 1, size).ok());
}

}  // namespace
}  // namespace tetskin::test
