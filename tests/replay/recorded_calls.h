// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world with everything in it, and how it is shown that a call between steps is recorded and saved.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/replay/recorder.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "replay/replay_models.h"
#include "replay/replay_scenes.h"

namespace tetskin::test {

using Bytes = std::vector<unsigned char>;

inline constexpr btScalar kCallFrame = btScalar(1) / 60;
/// Frames of a run; those from `kCalled` on, `kCalls` in number, begin with the call.
inline constexpr int kRun = 8, kCalled = 3, kCalls = 2;

inline btTransform placedAt(double x, double y, double z) {
  return btTransform(btMatrix3x3::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

inline const ReplayModel& smallBall() {
  static ReplayModel model = ballModel(2, 4);
  (void)model.shape();
  return model;
}
inline const ReplayModel& smallBar() {
  static ReplayModel model = barModel(4, 1, 0.25);
  (void)model.shape();
  return model;
}

/// A pinned bar; a ball that lies on the floor, with a box on it, drawn by a spring; a door on a hinge with a motor, a
/// slider, a kinematic plate with a box on it; and, unless it is plain, an arm, and a body on Bullet's anchors.
class CallScene {
 public:
  explicit CallScene(bool plain) {
    rigid(floorShape, 0, placedAt(0, 0, 0));
    bar = soft(smallBar(), {-2, 1, 0}, [](const Eigen::Vector3d& p) { return p.x() < -2.4; });
    barContact = SurfaceContact::add(world, bar->body(), *smallBar().binding, smallBar().mesh).value();
    ball = soft(smallBall(), {0, 0.5, 0}, nullptr);
    ballContact = SurfaceContact::add(world, ball->body(), *smallBall().binding, smallBall().mesh).value();
    second = soft(smallBall(), {0.9, 0.55, 0.1}, nullptr);
    contacts = SoftContacts::add(world).value();
    for (const auto* body : {&ball, &second}) (void)contacts->add((*body)->body(), shapeOf(smallBall()));
    box = &rigid(boxShape, 1, placedAt(0, 1.2, 0));
    spare = &rigid(boxShape, 0.5, placedAt(3, 0.25, 0));
    compound.addChildShape(placedAt(-0.1, 0, 0), &boxShape);
    compound.addChildShape(placedAt(0.1, 0, 0), &boxShape);
    pile = &rigid(compound, 1, placedAt(3, 0.8, 0));
    door = &rigid(boxShape, 1, placedAt(0, 2.5, 3));
    hinge = std::make_unique<btHingeConstraint>(*door, placedAt(0, 0.4, 0), true);
    cart = &rigid(boxShape, 1, placedAt(1, 2.5, 3));
    slider = std::make_unique<btSliderConstraint>(*cart, placedAt(0, 0, 0), true);
    cart->setActivationState(DISABLE_DEACTIVATION);
    sixFrame = &rigid(boxShape, 1, placedAt(2, 2.5, 3));
    six = std::make_unique<btGeneric6DofSpring2Constraint>(*sixFrame, placedAt(0, 0.3, 0));
    for (btTypedConstraint* joint : joints()) world.addConstraint(joint);
    plate = &rigid(plateShape, 0, placedAt(-2, 0.2, 3), &plateState);
    plate->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    plate->setActivationState(DISABLE_DEACTIVATION);
    rider = &rigid(boxShape, 1, placedAt(-2, 0.5, 3));
    const SurfaceTree tree = SurfaceTree::create(smallBall().binding, smallBall().mesh).value();
    top = tree.pointAtRest(ball->body(), {0, 0.45, 0}).value();
    spring = SurfaceSpring::add(world, tree.pointAtRest(ball->body(), {0, 0, 0.45}).value()).value();
    if (!plain) addArm();
  }
  ~CallScene() {
    for (auto& joint : linkJoints) world.removeMultiBodyConstraint(joint.get());
    if (arm) world.removeMultiBody(arm.get());
    for (auto& link : links) world.removeCollisionObject(link.get());
    for (btTypedConstraint* joint : joints()) {
      if (joint) world.removeConstraint(joint);
    }
    weld.reset(), spring.reset();
    bar.reset(), ball.reset(), second.reset(), extra.reset();
    for (auto& body : bodies) {
      if (body->isInWorld()) world.removeRigidBody(body.get());
    }
  }
  CallScene(const CallScene&) = delete;
  CallScene& operator=(const CallScene&) = delete;

  static std::shared_ptr<const ContactShape> shapeOf(const ReplayModel& model) {
    return const_cast<ReplayModel&>(model).shape();
  }
  std::unique_ptr<DeformableBody> soft(const ReplayModel& model, const Eigen::Vector3d& offset,
                                       std::function<bool(const Eigen::Vector3d&)> pinned) {
    SoftBodyOptions options;
    options.relativeStiffness = 60;
    options.faceTree = false;
    options.pinned = std::move(pinned);
    return DeformableBody::add(world, movedBy(model.cage, offset), options).value();
  }
  btRigidBody& rigid(btCollisionShape& shape, double mass, const btTransform& at, btMotionState* state = nullptr) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(btScalar(mass), inertia);
    bodies.push_back(std::make_unique<btRigidBody>(btScalar(mass), state, &shape, inertia));
    btRigidBody& body = *bodies.back();
    if (state) {
      state->setWorldTransform(at);
    }
    body.setWorldTransform(at);
    body.setInterpolationWorldTransform(at);
    world.addRigidBody(&body);
    return body;
  }
  std::vector<btTypedConstraint*> joints() { return {hinge.get(), slider.get(), six.get()}; }
  void step() { world.stepSimulation(kCallFrame, 2, kCallFrame / 2); }
  btSoftBody& softBall() { return ball->body(); }
  btSoftBody::Node& node(int n) { return ball->body().m_nodes[n]; }

  tetskin::DeformableWorld world;
  btStaticPlaneShape floorShape{btVector3(0, 1, 0), 0};
  btBoxShape boxShape{btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2))};
  btBoxShape plateShape{btVector3(1, btScalar(0.1), 1)};
  btSphereShape sphereShape{btScalar(0.2)};
  btCompoundShape compound;
  btDefaultMotionState plateState, boxState;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::unique_ptr<DeformableBody> bar, ball, second, extra;
  std::unique_ptr<SurfaceContact> barContact, ballContact, secondContact;
  std::unique_ptr<SoftContacts> contacts;
  std::unique_ptr<SurfaceSpring> spring;
  std::unique_ptr<SurfaceWeld> weld;
  std::unique_ptr<ForceRecord> record;
  SurfacePoint top;
  btRigidBody *box = nullptr, *spare = nullptr, *pile = nullptr, *door = nullptr, *cart = nullptr, *sixFrame = nullptr,
              *plate = nullptr, *rider = nullptr;
  std::unique_ptr<btHingeConstraint> hinge;
  std::unique_ptr<btSliderConstraint> slider;
  std::unique_ptr<btGeneric6DofSpring2Constraint> six;
  std::unique_ptr<btMultiBody> arm;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> links;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> linkJoints;
  btMultiBodyJointMotor* motor = nullptr;
  btMultiBodyJointLimitConstraint* limit = nullptr;

 private:
  void addArm() {
    btVector3 inertia;
    boxShape.calculateLocalInertia(1, inertia);
    arm = std::make_unique<btMultiBody>(2, btScalar(1), inertia, false, true);
    const btVector3 down(0, btScalar(-0.3), 0);
    arm->setBasePos(btVector3(-6, btScalar(1.5), 0));
    arm->setupRevolute(0, 1, inertia, -1, btQuaternion(0, 0, btScalar(0.5)), btVector3(0, 0, 1), down, down, true);
    arm->setupSpherical(1, 1, inertia, 0, btQuaternion::getIdentity(), down, down, true);
    arm->finalizeMultiDof();
    world.addMultiBody(arm.get());
    for (int k = 0; k < 2; ++k) {
      links.push_back(std::make_unique<btMultiBodyLinkCollider>(arm.get(), k));
      links.back()->setCollisionShape(&sphereShape);
      world.addCollisionObject(links.back().get(), 1, -1);
      arm->getLink(k).m_collider = links.back().get();
    }
    auto drive = std::make_unique<btMultiBodyJointMotor>(arm.get(), 0, btScalar(1), btScalar(0.05));
    auto bound = std::make_unique<btMultiBodyJointLimitConstraint>(arm.get(), 0, btScalar(-0.5), btScalar(0.5));
    motor = drive.get(), limit = bound.get();
    linkJoints.push_back(std::move(drive));
    linkJoints.push_back(std::move(bound));
    for (auto& joint : linkJoints) world.addMultiBodyConstraint(joint.get());
    btSoftBody& held = second->body();
    held.appendDeformableAnchor(0, spare);
  }
};

/// The effect of a call.
enum class Kind {
  Change,     ///< it is in the file
  Unseen,     ///< the same, but bodies move as without it
  Outside,    ///< the same, but a snapshot does not hold it: a program must make the call itself
  Structure,  ///< objects, joints or shapes change: a program must make the call itself
  Refused,    ///< neither saved nor recorded, and the status says so
};

struct Call {
  const char* name;
  std::function<void(CallScene&, int)> make;  ///< number of the call, from 0
  Kind kind = Kind::Change;
};

inline Bytes savedBytes(CallScene& scene) {
  Bytes bytes(saveSnapshot(scene.world, nullptr, 0).value());
  EXPECT_TRUE(saveSnapshot(scene.world, bytes.data(), bytes.size()).ok());
  return bytes;
}

/// The states in which runs begin, by name: falling, and asleep.
inline const std::vector<std::pair<std::string, Bytes>>& beginnings(bool plain) {
  static std::vector<std::pair<std::string, Bytes>> of[2];
  auto& all = of[plain ? 1 : 0];
  if (!all.empty()) return all;
  CallScene scene(plain);
  for (int frame = 0; frame < 6; ++frame) scene.step();
  all.emplace_back("moving", savedBytes(scene));
  for (int frame = 0; frame < 600 && scene.softBall().isActive(); ++frame) scene.step();
  EXPECT_FALSE(scene.softBall().isActive());
  all.emplace_back("asleep", savedBytes(scene));
  return all;
}

/// A run with a call: its bits after each frame, and the state before and after the calls.
class CalledRun {
 public:
  CalledRun(const Call& call, bool plain, const Bytes& beginning) : call_(call), plain_(plain), beginning_(beginning) {
    const auto scene = begun();
    const auto recorder = Recorder::start(scene->world, path_).value();
    for (int frame = 0; frame < kRun; ++frame) {
      if (frame == kCalled) before_ = savedBytes(*scene);
      callBefore(*scene, frame);
      if (frame == kCalled + kCalls && call_.kind != Kind::Refused) after_ = savedBytes(*scene);
      recorder->step(kCallFrame, 2, kCallFrame / 2);
      hashes_.push_back(stateHash(scene->world));
    }
    status_ = recorder->status();
  }
  const Status& status() const { return status_; }

  ~CalledRun() { std::filesystem::remove(path_); }

  /// False if nothing has come of the call.
  bool differsFrom(const CalledRun& other) const { return hashes_ != other.hashes_; }

  void expectPlayed() const {
    const auto scene = begun();
    const auto replay = Replay::open(scene->world, path_);
    ASSERT_TRUE(replay.ok()) << replay.status().message;
    if (call_.kind == Kind::Structure) {
      replay.value()->onChange([&](std::size_t step) { callBefore(*scene, static_cast<int>(step)); });
    }
    for (int frame = 0; frame < kRun; ++frame) {
      ASSERT_TRUE(replay.value()->step())
          << frame << ' ' << replay.value()->status().message << replay.value()->report().object;
      ASSERT_EQ(stateHash(scene->world), hashes_[static_cast<std::size_t>(frame)]) << frame;
    }
    EXPECT_FALSE(replay.value()->report().differs) << replay.value()->report().object;
  }
  void expectGoesOnFromBefore() const {
    const auto scene = begun();
    for (int round = 0; round < (call_.kind == Kind::Structure ? 1 : 2); ++round) {
      const Status restored = restoreSnapshot(scene->world, before_.data(), before_.size());
      ASSERT_TRUE(restored.ok()) << restored.message;
      goOn(*scene, kCalled, true);
    }
  }
  void expectGoesOnFromAfter() const {
    const auto scene = begun();
    const bool again = call_.kind == Kind::Structure || call_.kind == Kind::Outside;
    for (int frame = 0; frame < kCalled + kCalls + 1; ++frame) {
      if (again) callBefore(*scene, frame);
      if (again || frame < 2) scene->step();
    }
    const Status restored = restoreSnapshot(scene->world, after_.data(), after_.size());
    ASSERT_TRUE(restored.ok()) << restored.message;
    goOn(*scene, kCalled + kCalls, false);
  }

 private:
  std::unique_ptr<CallScene> begun() const {
    auto scene = std::make_unique<CallScene>(plain_);
    EXPECT_TRUE(restoreSnapshot(scene->world, beginning_.data(), beginning_.size()).ok());
    return scene;
  }
  void callBefore(CallScene& scene, int frame) const {
    if (frame >= kCalled && frame < kCalled + kCalls) call_.make(scene, frame - kCalled);
  }
  void goOn(CallScene& scene, int from, bool calls) const {
    for (int frame = from; frame < kRun; ++frame) {
      if (calls) callBefore(scene, frame);
      scene.step();
      ASSERT_EQ(stateHash(scene.world), hashes_[static_cast<std::size_t>(frame)]) << frame;
    }
  }

  const Call& call_;
  bool plain_;
  const Bytes& beginning_;
  std::string path_ = testing::TempDir() + "call" + std::to_string(std::random_device()()) + ".replay";
  Bytes before_, after_;
  Status status_;
  std::vector<std::uint64_t> hashes_;
};

/// Each call in one of the states in which runs begin, in turn; with the environment variable TETSKIN_TEST_WHOLE_TABLES
/// in all of them.
inline void expectRepeats(const std::vector<Call>& calls, bool plain) {
  const bool all = std::getenv("TETSKIN_TEST_WHOLE_TABLES") != nullptr;
  const Call none{"nothing", [](CallScene&, int) {}};
  std::size_t number = 0;
  for (const auto& [state, beginning] : beginnings(plain)) {
    const CalledRun unchanged(none, plain, beginning);
    for (std::size_t k = all ? 0 : number; k < calls.size(); k += all ? 1 : 2) {
      const Call& call = calls[k];
      SCOPED_TRACE(std::string(call.name) + ", " + state);
      const CalledRun run(call, plain, beginning);
      EXPECT_EQ(run.status().code, call.kind == Kind::Refused ? StatusCode::NotSaved : StatusCode::Ok)
          << run.status().message;
      if (call.kind == Kind::Refused) continue;
      EXPECT_TRUE(run.differsFrom(unchanged) || call.kind == Kind::Unseen || state == "asleep") << "it does nothing";
      run.expectPlayed();
      run.expectGoesOnFromBefore();
      run.expectGoesOnFromAfter();
    }
    ++number;
  }
}

}  // namespace tetskin::test
