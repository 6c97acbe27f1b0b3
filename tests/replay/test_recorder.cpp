// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/recorder.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/solver/deformable_body.h>

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "replay/replay_models.h"
#include "replay/replay_scenes.h"

namespace tetskin::test {
namespace {

constexpr btScalar kFrame = btScalar(1) / 60;

/// A file that is removed with this object.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& name)
      : path(testing::TempDir() + name + std::to_string(std::random_device()()) + ".replay") {}
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::string path;
};

std::unique_ptr<Recorder> started(ReplayScene& scene, const std::string& path, int snapshotEvery = 25) {
  RecorderOptions options;
  options.snapshotEvery = snapshotEvery;
  options.description = "made by a test";
  return Recorder::start(scene.world(), path, options).value();
}

/// Records this many frames, and returns the hash of each.
std::vector<std::uint64_t> record(const std::string& name, const std::string& path, int frames) {
  const auto scene = ReplayScene::create(name);
  const auto recorder = started(*scene, path);
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame < frames; ++frame) {
    scene->act(frame);
    EXPECT_EQ(recorder->step(kFrame, 4, kFrame / 4), 4);
    hashes.push_back(stateHash(scene->world()));
  }
  EXPECT_TRUE(recorder->status().ok()) << recorder->status().message;
  EXPECT_EQ(recorder->steps(), hashes.size());
  return hashes;
}

/// Plays a file in a world; after each step, it has the state of the run.
std::unique_ptr<Replay> played(DeformableWorld& world, const std::string& path,
                               const std::vector<std::uint64_t>& hashes = {}) {
  auto replay = Replay::open(world, path).value();
  for (std::size_t k = 0; replay->step(); ++k) {
    EXPECT_TRUE(hashes.empty() || (k < hashes.size() && stateHash(world) == hashes[k])) << k << replay->report().object;
  }
  EXPECT_TRUE(hashes.empty() || replay->report().steps == hashes.size()) << replay->status().message;
  return replay;
}

/// Frames that are recorded in a world; its states after each.
std::vector<std::uint64_t> recorded(DeformableWorld& world, const std::string& path, int frames,
                                    const std::function<void(int)>& act = {}) {
  std::vector<std::uint64_t> hashes;
  const auto recorder = Recorder::start(world, path).value();
  for (int frame = 0; frame < frames; ++frame) {
    if (act) act(frame);
    recorder->step(kFrame, 4, kFrame / 4);
    hashes.push_back(stateHash(world));
  }
  return hashes;
}

class RecordedScenes : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, RecordedScenes, testing::Values("drag", "twist", "drop", "changing"));

TEST_P(RecordedScenes, ArePlayedToTheLastBitByAWorldToWhichNobodyDoesAnything) {
  const TemporaryFile file(GetParam());
  const std::vector<std::uint64_t> hashes = record(GetParam(), file.path, 60);
  const auto scene = ReplayScene::create(GetParam());
  const auto replay = played(scene->world(), file.path, hashes);
  EXPECT_TRUE(replay->status().ok()) << replay->status().message;
  EXPECT_FALSE(replay->report().differs) << replay->report().object;
  EXPECT_FALSE(replay->report().cutShort);
  EXPECT_EQ(Replay::descriptionOf(file.path).value(), "made by a test");
}

TEST(Recorder, WritesOnlyWhatHasChanged) {
  const TemporaryFile file("size");
  record("drag", file.path, 10);
  const auto first = std::filesystem::file_size(file.path);
  record("drag", file.path, 20);
  const auto more = std::filesystem::file_size(file.path) - first;
  EXPECT_LT(more, 10u * 1000u);
}

TEST(Recorder, StepsAsTheWorldDoes) {
  const TemporaryFile file("steps");
  const std::vector<std::uint64_t> hashes = record("drag", file.path, 20);
  const auto scene = ReplayScene::create("drag");
  for (int frame = 0; frame < 20; ++frame) scene->step(frame);
  EXPECT_EQ(stateHash(scene->world()), hashes.back());
}

/// Pushes an object within a step, which no recorder sees.
struct Push {
  int step = 0, at = 0;
  btRigidBody* body = nullptr;
};
void pushWithinStep(btDynamicsWorld* world, btScalar /*seconds*/) {
  auto& push = *static_cast<Push*>(world->getWorldUserInfo());
  if (push.step++ == push.at) push.body->setLinearVelocity(push.body->getLinearVelocity() + btVector3(0, 1, 0));
}

TEST(Replay, NamesTheFirstStepThatDiffersAndTheObject) {
  const TemporaryFile file("differs");
  record("drop", file.path, 30);
  const auto scene = ReplayScene::create("drop");
  Push push;
  push.at = 17 * 4 + 2;
  for (int k = 0; k < scene->world().getNumCollisionObjects(); ++k) {
    btRigidBody* rigid = btRigidBody::upcast(scene->world().getCollisionObjectArray()[k]);
    if (rigid && !rigid->isStaticOrKinematicObject()) push.body = rigid;
  }
  ASSERT_TRUE(push.body);
  scene->world().setInternalTickCallback(pushWithinStep, &push);
  const auto replay = played(scene->world(), file.path);
  EXPECT_TRUE(replay->status().ok()) << replay->status().message;
  EXPECT_TRUE(replay->report().differs);
  EXPECT_EQ(replay->report().steps, 18u);
  const std::string name = "object " + std::to_string(push.body->getWorldArrayIndex()) + " of the world, a rigid body";
  EXPECT_EQ(replay->report().object, name);
}

/// A bar that is led at one end, by a millimetre in each frame from the tenth on.
struct LedBar {
  LedBar() {
    SoftBodyOptions options;
    options.youngsModulus = 1e6;
    options.pinned = [](const Eigen::Vector3d& p) { return p.x() < -0.7; };
    bar = DeformableBody::add(world, barModel(6, 1, 0.25).cage, options).value();
  }
  void act(int frame) {
    for (int n = 0; n < bar->body().m_nodes.size() && frame >= 10; ++n) {
      if (!bar->isPinned(n)) continue;
      // Bullet's velocity of the node is 0 from here on, which the bodies' dynamics did not find out in a snapshot.
      if (frame % 7 == 0) (void)bar->setPinned(n);
      const btVector3 up(0, btScalar(0.001), 0);
      EXPECT_TRUE(bar->setPinnedPosition(n, bar->body().m_nodes[n].m_x + up).ok());
    }
  }
  DeformableWorld world;
  std::unique_ptr<DeformableBody> bar;
};

TEST(Replay, OfNodesThatAreLedAndPinnedAgainIsTheSameToTheLastBit) {
  const TemporaryFile file("led");
  std::vector<std::uint64_t> hashes;
  {
    LedBar scene;
    hashes = recorded(scene.world, file.path, 40, [&](int frame) { scene.act(frame); });
  }
  LedBar scene;
  EXPECT_FALSE(played(scene.world, file.path, hashes)->report().differs);
}

/// A motion state of the application, which moves when it is asked, and may not be told.
struct PathThatAdvances : btMotionState {
  void getWorldTransform(btTransform& to) const override {
    ++asked;
    to = btTransform(btMatrix3x3::getIdentity(), btVector3(btScalar(0.01 * asked), btScalar(0.1), 0));
  }
  void setWorldTransform(const btTransform&) override { ++told; }
  mutable int asked = 0;
  int told = 0;
};

/// A ball that falls onto a plate which such a path moves.
struct OnPath {
  explicit OnPath(DeformableWorld& to) : world(to) {
    for (btRigidBody* body : {&plate, &ball}) world.addRigidBody(body);
    plate.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    plate.setActivationState(DISABLE_DEACTIVATION);
    ball.setWorldTransform(btTransform(btMatrix3x3::getIdentity(), btVector3(0, btScalar(0.5), 0)));
    path.asked = 0;  // Bullet asks as it makes the plate
  }
  ~OnPath() {
    for (btRigidBody* body : {&plate, &ball}) world.removeRigidBody(body);
  }
  DeformableWorld& world;
  PathThatAdvances path;
  btBoxShape plateShape{btVector3(1, btScalar(0.1), 1)};
  btSphereShape ballShape{btScalar(0.2)};
  btRigidBody plate{0, &path, &plateShape}, ball{1, nullptr, &ballShape, btVector3(1, 1, 1)};
};

TEST(Replay, NeitherAsksNorTellsMotionStatesAndARecorderAsksNoMoreThanBullet) {
  const TemporaryFile file("path");
  std::vector<std::uint64_t> hashes;
  {
    DeformableWorld world;
    OnPath scene(world);
    hashes = recorded(world, file.path, 30);
    EXPECT_EQ(scene.path.asked, 30);
    EXPECT_EQ(scene.path.told, 0);
  }
  DeformableWorld world;
  OnPath scene(world);
  const auto replay = played(world, file.path, hashes);
  EXPECT_EQ(scene.path.asked, 0);
  EXPECT_EQ(scene.path.told, 0);
  EXPECT_EQ(scene.plate.getMotionState(), &scene.path);
}

/// A callback of Bullet's in a step: it keeps the plate's current motion state, and may remove the plate.
struct PlateWatch {
  OnPath& scene;
  std::vector<btMotionState*> seen;
  bool removes = false;

  explicit PlateWatch(OnPath& to) : scene(to) {
    for (const bool before : {true, false}) scene.world.setInternalTickCallback(&PlateWatch::look, this, before);
  }
  static void look(btDynamicsWorld* world, btScalar) {
    auto& watch = *static_cast<PlateWatch*>(world->getWorldUserInfo());
    watch.seen.push_back(watch.scene.plate.getMotionState());
    if (watch.removes) world->removeRigidBody(&watch.scene.plate);
  }
};

TEST(Replay, LeavesMotionStatesToWhatAStepCallsAlsoOfABodyThatThisRemoves) {
  const TemporaryFile file("watched");
  const auto secondsOf = [](int frame) { return frame == 2 ? btScalar(0) : kFrame; };
  {
    DeformableWorld world;
    OnPath scene(world);
    const auto recorder = Recorder::start(world, file.path).value();
    for (int frame = 0; frame < 5; ++frame) recorder->step(secondsOf(frame), 4, kFrame / 4);
  }
  DeformableWorld world;
  OnPath scene(world);
  PlateWatch watch(scene);
  const auto replay = Replay::open(world, file.path).value();
  for (int frame = 0; frame < 5; ++frame) {
    watch.removes = frame == 4;
    watch.seen.clear();
    (void)replay->step();
    EXPECT_EQ(watch.seen, std::vector<btMotionState*>(secondsOf(frame) > 0 ? 8 : 0, &scene.path)) << frame;
    EXPECT_EQ(scene.plate.getMotionState(), &scene.path) << frame;
  }
  EXPECT_FALSE(scene.plate.isInWorld());
  EXPECT_EQ(scene.path.asked, 0);
}

TEST(Replay, OfAFileThatWasCutShortPlaysItsWholeSteps) {
  const TemporaryFile file("cut");
  record("drag", file.path, 12);
  std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 5);
  const auto scene = ReplayScene::create("drag");
  const auto replay = played(scene->world(), file.path);
  EXPECT_TRUE(replay->status().ok());
  EXPECT_TRUE(replay->report().cutShort);
  EXPECT_FALSE(replay->report().differs);
  EXPECT_EQ(replay->report().steps, 11u);
}

TEST(Replay, OfDamagedFilesIsRefusedOrStops) {
  const TemporaryFile file("damaged");
  record("drag", file.path, 4);
  std::vector<char> whole(std::filesystem::file_size(file.path));
  std::ifstream(file.path, std::ios::binary).read(whole.data(), static_cast<std::streamsize>(whole.size()));
  const auto scene = ReplayScene::create("drag");
  std::mt19937 random(5);
  for (int k = 0; k < 60; ++k) {
    std::vector<char> damaged = whole;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 << random() % 8);
    std::ofstream(file.path, std::ios::binary).write(damaged.data(), static_cast<std::streamsize>(damaged.size()));
    auto opened = Replay::open(scene->world(), file.path);
    if (!opened.ok()) continue;
    while (opened.value()->step()) {
    }
    EXPECT_TRUE(!opened.value()->status().ok() || opened.value()->report().cutShort) << k;
  }
}

TEST(Replay, OfAnotherWorldIsRefused) {
  const TemporaryFile file("other");
  record("drag", file.path, 2);
  const auto scene = ReplayScene::create("drop");
  const std::uint64_t before = stateHash(scene->world());
  const Status refused = Replay::open(scene->world(), file.path).status();
  EXPECT_EQ(refused.code, StatusCode::SnapshotMismatch) << refused.message;
  EXPECT_EQ(stateHash(scene->world()), before);
  EXPECT_EQ(Replay::open(scene->world(), file.path + "x").status().code, StatusCode::FileNotFound);
  std::ofstream(file.path) << "something else";
  EXPECT_EQ(Replay::open(scene->world(), file.path).status().code, StatusCode::Malformed);
  EXPECT_EQ(Replay::descriptionOf(file.path).status().code, StatusCode::Malformed);
}

/// A ball that comes in the middle of a run.
struct Newcomer {
  explicit Newcomer(btDynamicsWorld& to) : world(to), body(btScalar(0.5), nullptr, &shape, btVector3(1, 1, 1)) {
    body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 3, 0)));
    world.addRigidBody(&body);
  }
  ~Newcomer() { world.removeRigidBody(&body); }
  btDynamicsWorld& world;
  btSphereShape shape{btScalar(0.2)};
  btRigidBody body;
};

TEST(Replay, AsksForWhatTheApplicationAddedInTheMiddle) {
  const TemporaryFile file("change");
  {
    const auto scene = ReplayScene::create("drop");
    const auto recorder = started(*scene, file.path);
    for (int frame = 0; frame < 10; ++frame) recorder->step(kFrame, 4, kFrame / 4);
    const Newcomer ball(scene->world());
    for (int frame = 0; frame < 20; ++frame) recorder->step(kFrame, 4, kFrame / 4);
    ASSERT_TRUE(recorder->status().ok());
  }
  const auto scene = ReplayScene::create("drop");
  std::unique_ptr<Newcomer> ball;
  {
    const auto replay = played(scene->world(), file.path);
    EXPECT_EQ(replay->report().steps, 10u);
    EXPECT_EQ(replay->status().code, StatusCode::SnapshotMismatch) << replay->status().message;
  }
  const auto replay = Replay::open(scene->world(), file.path).value();
  replay->onChange([&](std::size_t step) {
    EXPECT_EQ(step, 10u);
    ball = std::make_unique<Newcomer>(scene->world());
  });
  while (replay->step()) {
  }
  EXPECT_TRUE(replay->status().ok()) << replay->status().message;
  EXPECT_FALSE(replay->report().differs) << replay->report().object;
  EXPECT_EQ(replay->report().steps, 30u);
}

TEST(Snapshots, OfADeterministicWorldGoOnInANewOne) {
  DeformableWorldOptions options;
  options.deterministic = true;
  for (const char* name : {"twist", "drop"}) {
    const auto scene = ReplayScene::create(name, options);
    for (int frame = 0; frame < 20; ++frame) scene->step(frame);
    std::vector<unsigned char> snapshot(saveSnapshot(scene->world(), nullptr, 0).value());
    ASSERT_TRUE(saveSnapshot(scene->world(), snapshot.data(), snapshot.size()).ok());
    const auto other = ReplayScene::create(name, options);
    ASSERT_TRUE(restoreSnapshot(other->world(), snapshot.data(), snapshot.size()).ok());
    for (int frame = 20; frame < 40; ++frame) {
      scene->step(frame);
      other->step(frame);
      ASSERT_EQ(stateHash(other->world()), stateHash(scene->world())) << name << " " << frame;
    }
  }
}

TEST(Recorder, RefusesOptionsAndPlacesThatItCannotUse) {
  const auto scene = ReplayScene::create("drag");
  const TemporaryFile file("refused");
  RecorderOptions options;
  options.snapshotEvery = 0;
  EXPECT_EQ(Recorder::start(scene->world(), file.path, options).status().code, StatusCode::InvalidOption);
  EXPECT_FALSE(std::filesystem::exists(file.path));
  const Status refused = Recorder::start(scene->world(), testing::TempDir() + "no/such/folder/a.replay").status();
  EXPECT_EQ(refused.code, StatusCode::FileNotWritable);
}

#ifdef __linux__
TEST(Recorder, ThatCannotWriteSaysSoAndStepsOn) {
  const auto scene = ReplayScene::create("drag");
  const Status refused = Recorder::start(scene->world(), "/dev/full").status();
  EXPECT_EQ(refused.code, StatusCode::FileNotWritable) << refused.message;
}
#endif

TEST(Replay, MovesKinematicBodiesAsTheirMotionStatesWere) {
  const TemporaryFile file("kinematic");
  struct Moved {
    explicit Moved(btDynamicsWorld& to) : world(to), body(btScalar(0), &state, &shape) {
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      body.setActivationState(DISABLE_DEACTIVATION);
      world.addRigidBody(&body);
    }
    ~Moved() { world.removeRigidBody(&body); }
    btDynamicsWorld& world;
    btBoxShape shape{btVector3(btScalar(0.3), btScalar(0.3), btScalar(0.3))};
    btDefaultMotionState state{btTransform(btQuaternion::getIdentity(), btVector3(2, btScalar(0.4), 0))};
    btRigidBody body;
  };
  std::uint64_t last = 0;
  {
    const auto scene = ReplayScene::create("drop");
    Moved box(scene->world());
    const auto recorder = started(*scene, file.path);
    for (int frame = 0; frame < 40; ++frame) {
      box.state.m_graphicsWorldTrans.setOrigin(btVector3(btScalar(2 - frame / 16.0), btScalar(0.4), 0));
      recorder->step(kFrame, 4, kFrame / 4);
    }
    last = stateHash(scene->world());
  }
  const auto scene = ReplayScene::create("drop");
  Moved box(scene->world());
  const auto replay = played(scene->world(), file.path);
  EXPECT_TRUE(replay->status().ok()) << replay->status().message;
  EXPECT_FALSE(replay->report().differs) << replay->report().object;
  EXPECT_EQ(replay->report().steps, 40u);
  EXPECT_EQ(stateHash(scene->world()), last);
}

}  // namespace
}  // namespace tetskin::test
