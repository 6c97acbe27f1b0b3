// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies in contact continue from a snapshot like the run that saved it, to the bit.
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/contact/src/soft/pair_search.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/threads/thread_pool.h>

#include "soft_fixtures.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Balls and plates that fall into a heap.
struct SavedHeap : ReplayedScene {
  tetskin::DeformableWorld own;
  std::unique_ptr<SoftContacts> contacts = SoftContacts::add(own).value();
  std::vector<std::unique_ptr<DeformableBody>> bodies;

  explicit SavedHeap(ParallelFor* threads = nullptr) : own(DeformableWorldOptions{btVector3(0, -10, 0), threads}) {
    static const std::shared_ptr<const ContactShape> coarse = ball().makeShape({600, 24});
    add(plate().cage, Vector3d(0, -0.3, 0), 0.0, plate().shape, 1e4, true);
    for (int k = 0; k < 8; ++k) {
      const Vector3d at(0.2 * (k % 2), 0.6 * k, 0.15 * (k % 3));
      const bool flat = k % 3 == 2;
      add(flat ? plate().cage : ball().cage, at, 0.5 * k, flat ? plate().shape : coarse, 1000.0 * (1 + k), false);
    }
  }
  void add(TetMesh cage, const Vector3d& at, double angle, const std::shared_ptr<const ContactShape>& shape,
           double stiffness, bool held) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    for (Vector3d& p : cage.nodes) p = turn * p + at;
    SoftBodyOptions options;
    options.youngsModulus = stiffness;
    options.margin = 0.002;
    if (held) options.pinned = pinnedIn(Box3(Vector3d::Constant(-9), Vector3d::Constant(9)));
    bodies.push_back(DeformableBody::add(own, cage, oneKilogram(options)).value());
    EXPECT_TRUE(contacts->add(bodies.back()->body(), shape).ok());
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return own; }
  void frame(int) override { own.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240); }
};

TEST(SnapshotsOfSoftContact, GoOnInTheSameWorldAndInANewOneOnOtherThreads) {
  const auto alone = [] { return std::make_unique<SavedHeap>(); };
  ThreadPool threads(2);
  expectReplays(alone, alone, 60, {0, 17, 39, 55});
  expectReplays(alone, [&] { return std::make_unique<SavedHeap>(&threads); }, 60, {25, 50});
}

TEST(SnapshotsOfSoftContact, AmongOtherBodiesAreRefusedAndChangeNothing) {
  SavedHeap heap;
  const Bytes all = saved(heap);
  for (int k = 0; k < 5; ++k) heap.frame(k);
  heap.contacts->remove(heap.bodies.back()->body());
  expectRefused(heap.own, all, StatusCode::SnapshotMismatch, "contacts among other soft bodies were there");
}

TEST(SnapshotsOfSoftContact, HoldTheSamplesThatTouchedOrPierced) {
  using namespace contact_detail;
  tetskin::DeformableWorld world;
  PairMemory saved, restored;
  saved.touched = {{2, 0}, {5, 3}};
  saved.pierced = {2, 7};
  restored.pierced = {1};
  std::vector<Touch> touches;
  Bytes bytes(1000);
  bullet_detail::WorldStream out(world, bytes.data(), bytes.size()),
      in(world, static_cast<const unsigned char*>(bytes.data()), bytes.size());
  saved.serialize(out, touches, false);
  restored.serialize(in, touches, false);
  EXPECT_EQ(restored.pierced, saved.pierced);
  ASSERT_EQ(restored.touched.size(), 2U);
  EXPECT_EQ(restored.touched[1].sample, 5);
  EXPECT_EQ(restored.touched[1].age, 3);
}

}  // namespace
}  // namespace tetskin::test
