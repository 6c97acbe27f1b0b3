// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/threads/thread_pool.h>

#include "contact_test.h"
#include "support/replays.h"

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

TEST(SnapshotsWithContacts, OfASurfaceOnBoxes) {
  expectReplays([] { return std::make_unique<OnBoxes>(); }, 150, {5, 20, 60, 140});
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
