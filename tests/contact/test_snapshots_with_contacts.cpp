// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/threads/thread_pool.h>

#include <random>

#include "contact_test.h"
#include "support/replays.h"
#include "support/snapshot_parts.h"

namespace tetskin::test {
namespace {

/// A ball that falls on two boxes.
class OnBoxes : public ReplayedScene {
 public:
  explicit OnBoxes(ParallelFor* threads = nullptr) {
    world_.bodySolver().setThreads(threads);
    const btVector3 places[2] = {btVector3(btScalar(-0.35), btScalar(0.21), 0),
                                 btVector3(btScalar(0.35), btScalar(0.21), 0)};
    for (int k = 0; k < 2; ++k) {
      btVector3 inertia;
      shape_.calculateLocalInertia(btScalar(0.3), inertia);
      boxes_[k] = std::make_unique<btRigidBody>(btScalar(0.3), nullptr, &shape_, inertia);
      boxes_[k]->setWorldTransform(btTransform(btMatrix3x3::getIdentity(), places[k]));
      world().addRigidBody(boxes_[k].get());
    }
    ball_ = std::make_unique<TouchingBody>(world_, ballMesh(8, 0.3), btVector3(btScalar(0.05), btScalar(0.8), 0));
  }
  ~OnBoxes() override {
    for (const auto& box : boxes_) world().removeRigidBody(box.get());
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return world_.deformable(); }
  void frame(int) override { step(world_, 1); }

 private:
  TetskinWorld world_;
  btBoxShape shape_{btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2))};
  std::unique_ptr<btRigidBody> boxes_[2];
  std::unique_ptr<TouchingBody> ball_;
};

/// A ball, and a cage that touches at its nodes, on a mesh, a hull and a compound; and a plate that comes and goes.
class OnKinds : public ReplayedScene {
 public:
  OnKinds() {
    const auto corner = [](int x, int z) {
      return btVector3(btScalar(0.5 * x), btScalar(0.05 * ((x * x + 2 * z) % 3)), btScalar(0.5 * z));
    };
    for (int x = -3; x < 3; ++x) {
      for (int z = -3; z < 3; ++z) {
        triangles_.addTriangle(corner(x, z), corner(x + 1, z + 1), corner(x + 1, z));
        triangles_.addTriangle(corner(x, z), corner(x, z + 1), corner(x + 1, z + 1));
      }
    }
    mesh_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    for (int k = 0; k < 14; ++k) {
      hull_.addPoint(btScalar(0.2) * btVector3(btCos(btScalar(k)), btSin(btScalar(3 * k)), btSin(btScalar(k) + 1)));
    }
    for (const int x : {-1, 1}) {
      compound_.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.1 * x), 0, 0)), &small_);
    }
    add(*mesh_, 0, btVector3(0, 0, 0));
    add(hull_, btScalar(0.3), btVector3(btScalar(-0.2), btScalar(0.4), btScalar(0.1)));
    add(compound_, btScalar(0.3), btVector3(btScalar(0.3), btScalar(0.4), 0));
    add(small_, 0, btVector3(1, 1, 0)).setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    ball_ = std::make_unique<TouchingBody>(world_, ballMesh(8, 0.3), btVector3(btScalar(0.05), btScalar(0.9), 0));
    cage_ = added(world_, smallCageAbove(1.6));
  }
  ~OnKinds() override {
    for (const auto& body : rigid_) world().removeRigidBody(body.get());
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return world_.deformable(); }
  void frame(int number) override {
    const btVector3 at(btSin(btScalar(0.1) * btScalar(number)), btScalar(0.4), btScalar(0.2));
    rigid_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    step(world_, 1);
  }

 private:
  btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& at) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    rigid_.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
    rigid_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    world().addRigidBody(rigid_.back().get());
    return *rigid_.back();
  }

  TetskinWorld world_;
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> mesh_;
  btConvexHullShape hull_;
  btCompoundShape compound_;
  btBoxShape small_{btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))};
  std::vector<std::unique_ptr<btRigidBody>> rigid_;
  std::unique_ptr<TouchingBody> ball_;
  std::unique_ptr<DeformableBody> cage_;
};

TEST(SnapshotsWithContacts, OfSoftBodiesOnShapesOfAllKinds) {
  expectReplays([] { return std::make_unique<OnKinds>(); }, 120, {5, 40, 80, 110});
}

/// The other parts: test_snapshot_parts.cpp.
TEST(SnapshotsWithContacts, NeedWhatTheSearchRemembers) {
  OnKinds scene;
  int number = 0, needed = 0;
  for (const int from : {10, 20, 30, 40, 60, 80, 100}) {
    while (number < from) scene.frame(number++);
    const Bytes snapshot = saved(scene);
    scene.frame(number++);
    const Bytes later = saved(scene);
    const auto run = [&](const Bytes& bytes) {
      std::vector<btScalar> all;
      restore(scene, bytes);
      for (int f = from; f < from + 20; ++f) {
        scene.frame(f);
        const std::vector<btScalar> now = seen(scene);
        all.insert(all.end(), now.begin(), now.end());
      }
      return all;
    };
    needed += !haveSameBits(run(snapshot), run(withPartOf(later, kContactSearch, snapshot)));
    restore(scene, later);
  }
  EXPECT_GT(needed, 0);
}

/// A snapshot has no clearances, so that restoring drops them: what is far away is searched for again. A run that drops
/// them in each frame, or now and then, goes on as one that keeps them.
TEST(SnapshotsWithContacts, ClearancesChangeNoBit) {
  OnKinds kept, always, sometimes;
  std::mt19937 random(3);
  for (int f = 0; f < 150; ++f) {
    restore(always, saved(always));
    if (random() % 3 == 0) restore(sometimes, saved(sometimes));
    for (ReplayedScene* scene : {static_cast<ReplayedScene*>(&kept), static_cast<ReplayedScene*>(&always),
                                 static_cast<ReplayedScene*>(&sometimes)}) {
      scene->frame(f);
    }
    ASSERT_TRUE(haveSameBits(seen(kept), seen(always))) << f;
    ASSERT_TRUE(haveSameBits(seen(kept), seen(sometimes))) << f;
  }
}

TEST(SnapshotsWithContacts, OnAnotherNumberOfThreads) {
  ThreadPool threads(2);
  OnBoxes first, second(&threads);
  for (int f = 0; f < 30; ++f) first.frame(f);
  restore(second, saved(first));
  for (int f = 30; f < 60; ++f) {
    first.frame(f);
    second.frame(f);
    ASSERT_TRUE(haveSameBits(seen(first), seen(second))) << f;
  }
}

}  // namespace
}  // namespace tetskin::test
