// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Objects that a snapshot cannot hold, and bytes that are not a snapshot: refused with the reason, and nothing is
// changed.
#include "solver/rigid_scene.h"

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/replay/src/state/snapshot_bytes.h>

#include <cstring>
#include <random>
#include <tuple>

#include "solver/deformable_test.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

using bullet_detail::kHashAt;
using bullet_detail::kHashedFrom;

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

  RigidScene scene;
  Bytes snapshot;
};

struct NoAction : btActionInterface {
  void updateAction(btCollisionWorld*, btScalar) override {}
  void debugDraw(btIDebugDraw*) override {}
};

/// A joint of a class that Bullet does not have.
struct OwnHinge : btHingeConstraint {
  using btHingeConstraint::btHingeConstraint;
  void getInfo2(btConstraintInfo2* info) override { btHingeConstraint::getInfo2(info); }
};

/// Changes by an application, and their messages.
struct Changed {
  const char* named;
  std::function<void(RigidScene&)> change;
};

TEST(RefusedSnapshotsOfChangedWorlds, NameWhatHasChanged) {
  const Changed changes[] = {
      {"(a rigid body, user index 23) has been added",
       [](RigidScene& s) { s.add(s.shape<btSphereShape>(btScalar(0.2)), 1, btVector3(9, 9, 9)).setUserIndex(23); }},
      {"object 3 (a rigid body, user index 3) has been removed", [](RigidScene& s) { s.remove(*s.bodies[3]); }},
      {"object 2 (a rigid body, user index 2) has another shape",
       [](RigidScene& s) { s.bodies[2]->setCollisionShape(&s.shape<btBoxShape>(btVector3(1, 1, btScalar(0.2)))); }},
      {"object 1 (",
       [](RigidScene& s) { s.bodies[1]->getCollisionShape()->setLocalScaling(btVector3(1, 1, btScalar(1.01))); }},
      {"object 1 (", [](RigidScene& s) { s.bodies[1]->getCollisionShape()->setMargin(btScalar(0.01)); }},
      {"its joint 12 is missing",
       [](RigidScene& s) {
         s.world.removeConstraint(s.joints.back().get());
         s.joints.pop_back();
       }},
      {"the world has more", [](RigidScene& s) { s.join<btPoint2PointConstraint>(*s.bodies[1], btVector3(0, 0, 0)); }},
      {"its joint of multibodies 0 is missing",
       [](RigidScene& s) {
         for (auto& joint : s.linkJoints_) s.world.removeMultiBodyConstraint(joint.get());
       }},
      {"its multibody 0 is missing", [](RigidScene& s) {
         for (auto& joint : s.linkJoints_) s.world.removeMultiBodyConstraint(joint.get());
         s.world.removeMultiBody(s.multibodies[0].get());
       }}};
  for (const Changed& changed : changes) {
    SCOPED_TRACE(changed.named);
    RigidScene scene;
    build(scene);
    scene.step(30);
    const Bytes snapshot = saved(scene.world);
    scene.step(5);
    changed.change(scene);
    expectRefused(scene.world, snapshot, StatusCode::SnapshotMismatch, changed.named);
  }
}

TEST_F(RefusedSnapshots, NameADeterministicWorldAndOneThatIsNot) {
  RigidScene other;
  build(other);
  other.world.deformableSolver().setDeterministic(true);
  const Bytes deterministic = saved(other.world);
  expectRefused(scene.world, deterministic, StatusCode::SnapshotMismatch, "it was deterministic, and this one is not");
  expectRefused(other.world, snapshot, StatusCode::SnapshotMismatch, "it was not deterministic, and this one is");
  scene.world.deformableSolver().setDeterministic(true);
  EXPECT_TRUE(restored(scene.world, deterministic).ok());
}

/// As many calls of addFibres, for other tets.
TEST(RefusedSnapshotsOfChangedWorlds, NameOtherFibres) {
  TetskinWorld worlds[2];
  std::unique_ptr<DeformableBody> bodies[2];
  for (const std::size_t k : {0, 1}) {
    bodies[k] = added(worlds[k], smallCageAbove(1.0));
    Fibres fibres;
    fibres.tets = k == 0 ? std::vector<int>{0} : std::vector<int>{0, 1};
    fibres.directions = {Eigen::Vector3d(1, 0, 0)};
    fibres.stiffness = 1e4;
    ASSERT_TRUE(bodies[k]->addFibres(fibres).ok());
  }
  const Bytes snapshot = saved(worlds[0].deformable());
  EXPECT_TRUE(restored(worlds[0].deformable(), snapshot).ok());
  expectRefused(worlds[1].deformable(), snapshot, StatusCode::SnapshotMismatch, "a soft body has other fibres");
}

/// A compound's child that has moved; a joint of another class, although Bullet calls both hinges.
TEST(RefusedSnapshotsOfChangedWorlds, SeeChildrenOfShapesAndClassesOfJoints) {
  RigidScene compounds[2], hinges[2];
  for (std::size_t k = 0; k < 2; ++k) {
    auto& compound = compounds[k].shape<btCompoundShape>();
    auto& ball = compounds[k].shape<btSphereShape>(btScalar(0.2));
    for (const int x : {-1, 0, 1}) {
      compound.addChildShape(placeAt(btVector3(btScalar(x), 0, btScalar(x == 0 && k == 1 ? 0.05 : 0))), &ball);
    }
    compounds[k].add(compound, 1, btVector3(0, 5, 0));
    btRigidBody& body = hinges[k].add(hinges[k].shape<btSphereShape>(btScalar(0.2)), 1, btVector3(0, 1, 0));
    const btTransform frame = btTransform::getIdentity();
    if (k == 0) hinges[k].join<btHingeConstraint>(body, frame);
    if (k == 1) hinges[k].join<btHingeAccumulatedAngleConstraint>(body, frame);
    hinges[k].step();
  }
  expectRefused(compounds[1].world, saved(compounds[0].world), StatusCode::SnapshotMismatch, "object 0 (");
  expectRefused(hinges[1].world, saved(hinges[0].world), StatusCode::SnapshotMismatch, "its joint 0 is missing");
}

/// They are static, since the world goes first.
TEST(RefusedSnapshotsOfChangedWorlds, HoldNothingThatSnapshotsDoNotKnow) {
  const Changed changes[] = {
      {"action 0 (",
       [](RigidScene& s) {
         static NoAction action;
         s.world.addAction(&action);
       }},
      {" (a ghost object",
       [](RigidScene& s) {
         static btGhostObject ghost;
         static btSphereShape ball(1);
         ghost.setCollisionShape(&ball);
         s.world.addCollisionObject(&ghost);
       }},
      {"joint 13 (", [](RigidScene& s) { s.join<OwnHinge>(*s.bodies[1], btTransform::getIdentity()); }},
      {" (it has no collision shape",  // nor does the broadphase know it
       [](RigidScene& s) {
         static btCollisionObject bare;
         static btSphereShape ball(1);
         bare.setCollisionShape(&ball);
         s.world.getCollisionObjectArray().push_back(&bare);
       }},
      {"object 2 (it has no collision shape", [](RigidScene& s) { s.bodies[2]->setCollisionShape(nullptr); }},
      {"a constraint solver", [](RigidScene& s) {
         static btMultiBodyConstraintSolver solver;
         s.world.setConstraintSolver(&solver);
       }}};
  for (const Changed& changed : changes) {
    SCOPED_TRACE(changed.named);
    RigidScene scene;
    build(scene);
    scene.step(5);
    const Bytes snapshot = saved(scene.world);
    changed.change(scene);
    const std::vector<btScalar> before = seen(scene.world);
    Bytes buffer(2 * snapshot.size());
    expectStatus(saveSnapshot(scene.world, nullptr, 0).status(), StatusCode::NotSaved, changed.named);
    expectStatus(saveSnapshot(scene.world, buffer.data(), buffer.size()).status(), StatusCode::NotSaved, changed.named);
    expectStatus(restored(scene.world, snapshot), StatusCode::NotSaved, changed.named);
    EXPECT_EQ(seen(scene.world), before);
  }
}

/// Neither within a step, nor between the steps of a frame: how many steps are left, and whose forces last until then,
/// is not known there.
TEST_F(RefusedSnapshots, AreNoneOfAWorldWithinAFrame) {
  static Bytes buffer;
  buffer = snapshot;
  static std::vector<Status> during;
  const auto both = [](btDeformableMultiBodyDynamicsWorld& world) {
    during.push_back(saveSnapshot(world, buffer.data(), buffer.size()).status());
    during.push_back(restored(world, buffer));
  };
  static const auto tell = both;
  scene.world.setSolverCallback([](btScalar, btDeformableMultiBodyDynamicsWorld* world) { tell(*world); });
  scene.step();
  scene.world.setSolverCallback(nullptr);
  EXPECT_GE(during.size(), 2u);
  for (const Status& status : during) expectStatus(status, StatusCode::NotSaved, "within a step");
  for (const bool before : {true, false}) {
    during.clear();
    const auto tick = [](btDynamicsWorld* of, btScalar) {
      tell(static_cast<btDeformableMultiBodyDynamicsWorld&>(*of));
    };
    scene.world.setInternalTickCallback(tick, nullptr, before);
    scene.step();
    scene.world.setInternalTickCallback(nullptr, nullptr, before);
    EXPECT_EQ(during.size(), 4u) << "two steps";
    for (const Status& status : during) expectStatus(status, StatusCode::NotSaved, "until stepSimulation ends");
  }
  EXPECT_TRUE(restored(scene.world, snapshot).ok());
}

TEST_F(RefusedSnapshots, OfAnotherKindOfMachineOrVersion) {
  const std::tuple<std::size_t, StatusCode, const char*> heads[] = {
      {0, StatusCode::Malformed, "does not begin"},
      {8, StatusCode::UnsupportedFormat, "another version"},
      {12, StatusCode::UnsupportedFormat, "another version"},
      {16, StatusCode::UnsupportedFormat, "its numbers have"},
      {20, StatusCode::UnsupportedFormat, "byte order"}};
  for (const auto& [at, code, named] : heads) {
    Bytes bytes = snapshot;
    bytes[at] ^= 12;
    expectRefused(scene.world, bytes, code, named);
  }
  expectRefused(scene.world, {}, StatusCode::Malformed, "0 bytes");
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
  const Bytes good = saved(scene.world);
  scene.step();
  const Bytes before = saved(scene.world);
  std::mt19937 random(1);
  for (int k = 0; k < 10000; ++k) {
    Bytes bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<unsigned char>(1u << random() % 8);
    ASSERT_FALSE(restoreSnapshot(scene.world, bytes.data(), bytes.size()).ok());
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Bytes bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(restored(scene.world, bytes).ok());
  }
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_FALSE(restoreSnapshot(scene.world, longer.data(), longer.size()).ok());
  EXPECT_EQ(saved(scene.world), before);
  EXPECT_TRUE(restoreSnapshot(scene.world, good.data(), good.size()).ok());
}

/// Bytes that were damaged before they were hashed: a world may then be anything, but no memory is harmed, and it can
/// be destroyed. For builds with sanitizers.
TEST(DamagedSnapshots, WithARightHashHarmNoMemory) {
  Bytes good;
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
    Bytes bytes = good;
    for (unsigned flips = 1 + random() % 3; flips > 0; --flips) {
      const std::size_t at = kHashedFrom + random() % (bytes.size() - kHashedFrom);
      bytes[at] ^= static_cast<unsigned char>(1u << random() % 8);
    }
    const std::uint64_t hash = hashInLanes(bytes.data() + kHashedFrom, bytes.size() - kHashedFrom);
    std::memcpy(bytes.data() + kHashAt, &hash, sizeof hash);
    if (restoreSnapshot(scene.world, bytes.data(), bytes.size()).ok()) ++accepted;
    (void)saved(scene.world);
  }
  EXPECT_GT(accepted, 100);  // most bytes are numbers, which may have any value
  EXPECT_LT(accepted, 400);
}

}  // namespace
}  // namespace tetskin::test
