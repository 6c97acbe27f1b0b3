// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a snapshot cannot hold, and bytes that are none: refused with the reason, and nothing is changed.
#include "saved.h"
#include "solver/rigid_scene.h"

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <gtest/gtest.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/replay/src/state/snapshot_hash.h>

#include <cstring>
#include <random>
#include <string>

namespace tetskin::test {
namespace {

using bullet_detail::kHashAt;
using bullet_detail::kHashedFrom;
using bullet_detail::snapshotHash;

void build(RigidScene& scene) {
  scene.addFloor();
  scene.addStack(4);
  scene.addJoints();
  scene.addArm();
}

void expectStatus(const Status& status, StatusCode code, const std::string& named) {
  EXPECT_EQ(status.code, code) << status.message;
  EXPECT_NE(status.message.find(named), std::string::npos) << status.message;
}

class RefusedSnapshots : public testing::Test {
 protected:
  RefusedSnapshots() {
    build(scene);
    scene.step(30);
    snapshot = saved(scene.world);
    scene.step(5);
  }
  /// Restoring fails so, and changes nothing.
  static void expectRefused(RigidScene& other, const Snapshot& bytes, StatusCode code, const std::string& named) {
    const Snapshot before = saved(other.world);
    expectStatus(restoreSnapshot(other.world, bytes.data(), bytes.size()), code, named);
    EXPECT_EQ(saved(other.world), before);
  }
  void expectMismatch(const std::string& named) { expectRefused(scene, snapshot, StatusCode::SnapshotMismatch, named); }
  void expectNotSaved(const std::string& named) {
    expectStatus(saveSnapshot(scene.world, nullptr, 0).status(), StatusCode::NotSaved, named);
    Snapshot buffer(2 * snapshot.size());
    expectStatus(saveSnapshot(scene.world, buffer.data(), buffer.size()).status(), StatusCode::NotSaved, named);
    const std::vector<btScalar> before = scene.motion();
    expectStatus(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()), StatusCode::NotSaved, named);
    EXPECT_EQ(scene.motion(), before);
  }

  RigidScene scene;
  Snapshot snapshot;
};

TEST_F(RefusedSnapshots, NameABodyThatWasAdded) {
  auto& ball = scene.shape<btSphereShape>(btScalar(0.2));
  scene.add(ball, 1, btVector3(9, 9, 9)).setUserIndex(1234);
  expectMismatch("(a rigid body, user index 1234) has been added");
}

TEST_F(RefusedSnapshots, NameABodyThatWasRemoved) {
  scene.remove(*scene.bodies[3]);
  expectMismatch("object 3 (a rigid body, user index 3) has been removed");
}

TEST_F(RefusedSnapshots, NameABodyOfAnotherShape) {
  scene.bodies[2]->setCollisionShape(&scene.shape<btBoxShape>(btVector3(1, 1, btScalar(0.2))));
  expectMismatch("object 2 (a rigid body, user index 2) has another shape");
}

TEST_F(RefusedSnapshots, NameADeterministicWorldAndOneThatIsNot) {
  RigidScene other;
  build(other);
  other.world.deformableSolver().setDeterministic(true);
  const Snapshot deterministic = saved(other.world);
  expectRefused(scene, deterministic, StatusCode::SnapshotMismatch, "it was deterministic, and this one is not");
  expectRefused(other, snapshot, StatusCode::SnapshotMismatch, "it was not deterministic, and this one is");
  scene.world.deformableSolver().setDeterministic(true);
  EXPECT_TRUE(restoreSnapshot(scene.world, deterministic.data(), deterministic.size()).ok());
}

TEST_F(RefusedSnapshots, SeeScaleMarginAndChildrenOfShapes) {
  btCollisionShape& box = *scene.bodies[1]->getCollisionShape();
  box.setLocalScaling(btVector3(1, 1, btScalar(1.01)));
  expectMismatch("object 1 (");
  box.setLocalScaling(btVector3(1, 1, 1));
  box.setMargin(btScalar(0.01));
  expectMismatch("object 1 (");
  RigidScene compounds[2];
  for (RigidScene& with : compounds) {
    auto& compound = with.shape<btCompoundShape>();
    auto& ball = with.shape<btSphereShape>(btScalar(0.2));
    for (const int x : {-1, 0, 1}) {
      const bool moved = x == 0 && &with == &compounds[1];
      compound.addChildShape(
          btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), 0, btScalar(moved ? 0.05 : 0))), &ball);
    }
    with.add(compound, 1, btVector3(0, 5, 0));
  }
  expectRefused(compounds[1], saved(compounds[0].world), StatusCode::SnapshotMismatch, "object 0 (");
}

TEST_F(RefusedSnapshots, NameAJointThatWasRemovedOrAdded) {
  std::unique_ptr<btTypedConstraint> joint = std::move(scene.joints.back());
  scene.joints.pop_back();
  scene.world.removeConstraint(joint.get());
  expectMismatch("its joint 12 is missing");
  scene.world.addConstraint(joint.get());
  EXPECT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
  btPoint2PointConstraint another(*scene.bodies[1], btVector3(0, 0, 0));
  scene.world.addConstraint(&another);
  expectMismatch("the world has more");
  scene.world.removeConstraint(&another);
  scene.world.removeConstraint(joint.get());
}

TEST_F(RefusedSnapshots, NameAMultiBodyThatIsMissing) {
  btMultiBody& arm = *scene.multibodies[0];
  for (auto& joint : scene.linkJoints_) scene.world.removeMultiBodyConstraint(joint.get());
  scene.world.removeMultiBody(&arm);
  expectMismatch("its multibody 0 is missing");
  scene.world.addMultiBody(&arm);
  expectMismatch("its joint of multibodies 0 is missing");
  for (auto& joint : scene.linkJoints_) scene.world.addMultiBodyConstraint(joint.get());
  EXPECT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
}

struct NoAction : btActionInterface {
  void updateAction(btCollisionWorld*, btScalar) override {}
  void debugDraw(btIDebugDraw*) override {}
};
struct OwnHinge : btHingeConstraint {
  using btHingeConstraint::btHingeConstraint;
  void getInfo2(btConstraintInfo2* info) override { btHingeConstraint::getInfo2(info); }
};

TEST_F(RefusedSnapshots, HoldNeitherActionsNorGhostsNorJointsOfYourOwn) {
  NoAction action;
  scene.world.addAction(&action);
  expectNotSaved("action 0 (");
  scene.world.removeAction(&action);
  btGhostObject ghost;
  ghost.setCollisionShape(&scene.shape<btSphereShape>(btScalar(1)));
  const int index = scene.world.getNumCollisionObjects();
  scene.world.addCollisionObject(&ghost);
  expectNotSaved("object " + std::to_string(index) + " (a ghost object");
  scene.world.removeCollisionObject(&ghost);
  OwnHinge hinge(*scene.bodies[1], btTransform::getIdentity());
  scene.world.addConstraint(&hinge);
  expectNotSaved("joint 13 (");
  scene.world.removeConstraint(&hinge);
}

TEST_F(RefusedSnapshots, HoldNoObjectWithoutShapeOrThatTheBroadphaseDoesNotKnow) {
  const std::string last = "object " + std::to_string(scene.world.getNumCollisionObjects());
  btCollisionObject bare;
  bare.setCollisionShape(&scene.shape<btSphereShape>(btScalar(1)));
  scene.world.getCollisionObjectArray().push_back(&bare);
  expectNotSaved(last + " (it has no collision shape");
  scene.world.getCollisionObjectArray().pop_back();
  btCollisionShape* const shape = scene.bodies[2]->getCollisionShape();
  scene.bodies[2]->setCollisionShape(nullptr);
  expectNotSaved("object 2 (it has no collision shape");
  scene.bodies[2]->setCollisionShape(shape);
  EXPECT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
}

/// Bullet calls both hinges.
TEST_F(RefusedSnapshots, NameAJointOfAnotherClass) {
  RigidScene scenes[2];
  for (RigidScene& with : scenes) {
    btRigidBody& body = with.add(with.shape<btSphereShape>(btScalar(0.2)), 1, btVector3(0, 1, 0));
    const btTransform frame = btTransform::getIdentity();
    if (&with == scenes) {
      with.join<btHingeConstraint>(body, frame);
    } else {
      with.join<btHingeAccumulatedAngleConstraint>(body, frame);
    }
    with.step();
  }
  expectRefused(scenes[1], saved(scenes[0].world), StatusCode::SnapshotMismatch, "its joint 0 is missing");
}

TEST_F(RefusedSnapshots, HoldNoOtherConstraintSolver) {
  btMultiBodyConstraintSolver solver;
  scene.world.setConstraintSolver(&solver);
  expectNotSaved("a constraint solver");
  scene.world.setConstraintSolver(&scene.world.constraintSolver());
}

TEST_F(RefusedSnapshots, AreNoneOfAWorldWithinAStep) {
  static Snapshot buffer;
  buffer = snapshot;
  static Status during[2];
  scene.world.setSolverCallback([](btScalar, btDeformableMultiBodyDynamicsWorld* world) {
    during[0] = saveSnapshot(*world, buffer.data(), buffer.size()).status();
    during[1] = restoreSnapshot(*world, buffer.data(), buffer.size());
  });
  scene.step();
  scene.world.setSolverCallback(nullptr);
  for (const Status& status : during) expectStatus(status, StatusCode::NotSaved, "within a step");
}

/// How many steps are left, and whose forces last until then, is not known there.
TEST_F(RefusedSnapshots, AreNoneBetweenTheStepsOfAFrame) {
  static Snapshot buffer;
  buffer = snapshot;
  static std::vector<Status> during;
  for (const bool before : {true, false}) {
    during.clear();
    const auto tick = [](btDynamicsWorld* of, btScalar) {
      auto& world = static_cast<btDeformableMultiBodyDynamicsWorld&>(*of);
      during.push_back(saveSnapshot(world, buffer.data(), buffer.size()).status());
      during.push_back(restoreSnapshot(world, buffer.data(), buffer.size()));
    };
    scene.world.setInternalTickCallback(tick, nullptr, before);
    scene.step();
    scene.world.setInternalTickCallback(nullptr, nullptr, before);
    EXPECT_EQ(during.size(), 4u) << "two steps";
    for (const Status& status : during) expectStatus(status, StatusCode::NotSaved, "until stepSimulation ends");
  }
  EXPECT_TRUE(restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok());
}

TEST_F(RefusedSnapshots, OfAnotherKindOfMachineOrVersion) {
  const auto changed = [this](std::size_t at) {
    Snapshot bytes = snapshot;
    bytes[at] ^= 12;
    return bytes;
  };
  expectRefused(scene, changed(0), StatusCode::Malformed, "does not begin");
  expectRefused(scene, changed(8), StatusCode::UnsupportedFormat, "another version");
  expectRefused(scene, changed(12), StatusCode::UnsupportedFormat, "another version");
  expectRefused(scene, changed(16), StatusCode::UnsupportedFormat, "its numbers have");
  expectRefused(scene, changed(20), StatusCode::UnsupportedFormat, "byte order");
  expectRefused(scene, {}, StatusCode::Malformed, "0 bytes");
  expectStatus(restoreSnapshot(scene.world, nullptr, 0), StatusCode::Malformed, "0 bytes");
}

/// A compound on another one, a joint, an arm.
void buildSmall(RigidScene& scene) {
  scene.addFloor();
  auto& compound = scene.shape<btCompoundShape>();
  auto& box = scene.shape<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));
  for (const int x : {-1, 1}) {
    compound.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.2 * x), 0, 0)), &box);
  }
  for (const double height : {0.2, 0.6}) scene.add(compound, 1, btVector3(0, btScalar(height), 0));
  scene.join<btHingeConstraint>(scene.add(box, 1, btVector3(2, 1, 0)), btTransform::getIdentity());
  scene.addArm();
}

/// A world that is small enough to be damaged in all places.
struct SmallScene : RigidScene {
  SmallScene() {
    addFloor();
    addStack(2);
    step(10);
  }
};

TEST(DamagedSnapshots, AreRefusedAndChangeNothing) {
  SmallScene scene;
  const Snapshot good = saved(scene.world);
  scene.step();
  const Snapshot before = saved(scene.world);
  std::mt19937 random(1);
  for (int k = 0; k < 10000; ++k) {
    Snapshot bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<unsigned char>(1u << random() % 8);
    ASSERT_FALSE(restoreSnapshot(scene.world, bytes.data(), bytes.size()).ok());
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Snapshot bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(restoreSnapshot(scene.world, bytes.data(), bytes.size()).ok());
  }
  Snapshot longer = good;
  longer.push_back(0);
  EXPECT_FALSE(restoreSnapshot(scene.world, longer.data(), longer.size()).ok());
  EXPECT_EQ(saved(scene.world), before);
  EXPECT_TRUE(restoreSnapshot(scene.world, good.data(), good.size()).ok());
}

/// Bytes that were damaged before they were hashed: a world may then be anything, but no memory is harmed, and it can
/// be destroyed. For builds with sanitizers.
TEST(DamagedSnapshots, WithARightHashHarmNoMemory) {
  Snapshot good;
  {
    RigidScene scene;
    buildSmall(scene);
    scene.step(20);
    good = saved(scene.world);
  }
  std::mt19937 random(2);
  int accepted = 0;
  for (int k = 0; k < 400; ++k) {
    RigidScene scene;
    buildSmall(scene);
    Snapshot bytes = good;
    for (unsigned flips = 1 + random() % 3; flips > 0; --flips) {
      const std::size_t at = kHashedFrom + random() % (bytes.size() - kHashedFrom);
      bytes[at] ^= static_cast<unsigned char>(1u << random() % 8);
    }
    const std::uint64_t hash = snapshotHash(bytes.data() + kHashedFrom, bytes.size() - kHashedFrom);
    std::memcpy(bytes.data() + kHashAt, &hash, sizeof hash);
    if (restoreSnapshot(scene.world, bytes.data(), bytes.size()).ok()) ++accepted;
    (void)saved(scene.world);
  }
  EXPECT_GT(accepted, 100);  // most bytes are numbers, of which any is possible
  EXPECT_LT(accepted, 400);
}

}  // namespace
}  // namespace tetskin::test
