// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Snapshots of worlds of rigid bodies, joints and multibodies: the restored world continues to the last bit, and the
// bytes of later snapshots agree.
#include "solver/rigid_scene.h"

#include <tetskin/replay/snapshot.h>

#include "support/replays.h"

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

/// A plate is moved in each frame, where there is one.
class RigidReplay : public ReplayedScene {
 public:
  explicit RigidReplay(const Kind& kind, const std::function<void(RigidScene&)>& before = {}) {
    if (before) before(scene);
    scene.addFloor();
    kind.build(scene);
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return scene.world; }
  void frame(int number) override {
    for (const auto& body : scene.bodies) {
      if (!body->isKinematicObject()) continue;
      btTransform at = body->getWorldTransform();
      at.getOrigin().setX(-3 + btScalar(0.3) * btSin(btScalar(0.05) * btScalar(number)));
      body->setWorldTransform(at);
    }
    scene.step();
  }
  RigidScene scene;
};

class SnapshotsOfRigidBodies : public testing::TestWithParam<Kind> {};

TEST_P(SnapshotsOfRigidBodies, GoOnAsBefore) {
  expectReplays([] { return std::make_unique<RigidReplay>(GetParam()); }, 150, {0, 1, 30, 120}, 25);
}

TEST_P(SnapshotsOfRigidBodies, GoOnInAWorldInWhichOthersHaveBeenBefore) {
  const auto churn = [](RigidScene& scene) {
    auto& ball = scene.shape<btSphereShape>(btScalar(1));
    for (const int height : {0, 1, 3}) scene.add(ball, 1, btVector3(0, btScalar(height), 0));
    scene.step(3);
    while (!scene.bodies.empty()) scene.remove(*scene.bodies.front());
  };
  expectReplays([] { return std::make_unique<RigidReplay>(GetParam()); },
                [&] { return std::make_unique<RigidReplay>(GetParam(), churn); }, 90, {50}, 40);
}

TEST_P(SnapshotsOfRigidBodies, GoOnAfterOtherBodiesHaveComeAndGone) {
  btSphereShape ball(btScalar(0.3));
  RigidReplay replay(GetParam(), [&](RigidScene& scene) {
    scene.add(ball, 1, btVector3(0, 9, 0));
    scene.add(ball, 1, btVector3(1, 9, 0));
  });
  RigidScene& scene = replay.scene;
  scene.remove(*scene.bodies.front());  // the last one takes its place in Bullet's lists
  std::vector<Frame> frames;
  for (int f = 0; f < 70; ++f) frames.push_back(run(replay, f));
  btRigidBody& guest = scene.add(ball, 5, btVector3(btScalar(0.3), 2, 0));
  btRigidBody& second = scene.add(ball, 5, btVector3(4, 4, 0));
  for (int k = 0; k < 20; ++k) replay.frame(k);
  scene.remove(guest);
  for (int k = 0; k < 5; ++k) replay.frame(k);
  scene.remove(second);
  expectFollows(replay, frames, 30);
}

INSTANTIATE_TEST_SUITE_P(, SnapshotsOfRigidBodies,
                         testing::Values(Kind{"stack", [](RigidScene& s) { s.addStack(60); }}, Kind{"all", buildAll}),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(SnapshotsOfRigidWorlds, OfAnEmptyWorldChangeNothing) {
  tetskin::DeformableWorld world;
  const Bytes snapshot = saved(world);
  EXPECT_TRUE(restored(world, snapshot).ok());
  EXPECT_EQ(saved(world), snapshot);
}

TEST(SnapshotsOfRigidWorlds, PutBackWhatTheApplicationHasChanged) {
  RigidScene scene;
  scene.addFloor();
  scene.addStack(10);
  scene.addJoints();
  scene.addArm();
  scene.step(20);
  const Bytes snapshot = saved(scene.world);
  scene.step(40);
  const std::vector<btScalar> later = seen(scene.world);
  ASSERT_TRUE(restored(scene.world, snapshot).ok());
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
  EXPECT_EQ(seen(scene.world), later);
}

TEST(SnapshotsOfRigidWorlds, TellMotionStates) {
  RigidScene scene;
  scene.addFloor();
  scene.addStack(1);
  btDefaultMotionState state;
  scene.bodies[1]->setMotionState(&state);
  scene.step(3);
  const Bytes snapshot = saved(scene.world);
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
