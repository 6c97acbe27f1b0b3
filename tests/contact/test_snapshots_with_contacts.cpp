// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/threads/thread_pool.h>

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
    auto& box = rigids_.shape<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));
    for (const double x : {-0.35, 0.35}) rigids_.add(box, 0.3, btVector3(btScalar(x), btScalar(0.21), 0));
    ball_ = std::make_unique<TouchingBody>(world_, ballMesh(8, 0.3), btVector3(btScalar(0.05), btScalar(0.8), 0));
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return world_.deformable(); }
  void frame(int) override { step(world_, 1); }

 private:
  TetskinWorld world_;
  Rigids rigids_{world_.deformable()};
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
    rigids_.add(*mesh_, 0, btVector3(0, 0, 0));
    rigids_.add(hull_, 0.3, btVector3(btScalar(-0.2), btScalar(0.4), btScalar(0.1)));
    rigids_.add(compound_, 0.3, btVector3(btScalar(0.3), btScalar(0.4), 0));
    rigids_.add(small_, 0, btVector3(1, 1, 0)).setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    ball_ = std::make_unique<TouchingBody>(world_, ballMesh(8, 0.3), btVector3(btScalar(0.05), btScalar(0.9), 0));
    cage_ = added(world_, smallCageAbove(1.6));
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return world_.deformable(); }
  void frame(int number) override {
    const btVector3 at(btSin(btScalar(0.1) * btScalar(number)), btScalar(0.4), btScalar(0.2));
    rigids_.bodies.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    step(world_, 1);
  }

 private:
  TetskinWorld world_;
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> mesh_;
  btConvexHullShape hull_;
  btCompoundShape compound_;
  btBoxShape small_{btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))};
  Rigids rigids_{world_.deformable()};
  std::unique_ptr<TouchingBody> ball_;
  std::unique_ptr<DeformableBody> cage_;
};

/// A soft plate of large triangles that lies on a box, with two boxes on it.
class Lying : public ReplayedScene {
 public:
  Lying() {
    auto& large = rigids_.shape<btBoxShape>(btVector3(2, btScalar(0.2), 2));
    auto& small = rigids_.shape<btBoxShape>(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.12)));
    rigids_.add(large, 0, btVector3(0, btScalar(-0.2), 0));
    plate_ = std::make_unique<TouchingBody>(world_, boxMesh(Eigen::Vector3d(0.4, 0.1, 0.4)),
                                            btVector3(0, btScalar(0.101), 0));
    for (const double x : {-0.2, 0.17}) rigids_.add(small, 0.3, btVector3(btScalar(x), btScalar(0.305), 0));
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return world_.deformable(); }
  void frame(int) override { step(world_, 1); }

 private:
  TetskinWorld world_;
  Rigids rigids_{world_.deformable()};
  std::unique_ptr<TouchingBody> plate_;
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

/// A snapshot has no clearances, so restoring drops them: distant objects are searched again. A run that drops them in
/// each frame, or now and then, continues like one that keeps them.
template <class Scene>
void expectNoBitByClearances(int frames) {
  Scene kept, always, sometimes;
  std::mt19937 random(3);
  for (int f = 0; f < frames; ++f) {
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

TEST(SnapshotsWithContacts, ClearancesChangeNoBit) {
  expectNoBitByClearances<OnKinds>(150);
}

/// What lies is followed, not searched anew: snapshots know from where.
TEST(SnapshotsWithContacts, OfWhatLiesChangeNoBit) {
  expectNoBitByClearances<Lying>(90);
  expectReplays([] { return std::make_unique<Lying>(); }, 60, {20, 50});
}

TEST(SnapshotsWithContacts, OnAnotherNumberOfThreads) {
  ThreadPool threads(2);
  expectReplays([] { return std::make_unique<OnBoxes>(); }, [&] { return std::make_unique<OnBoxes>(&threads); }, 60,
                {29});
}

}  // namespace
}  // namespace tetskin::test
