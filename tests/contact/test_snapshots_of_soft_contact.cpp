// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies that meet each other go on from a snapshot as they did when it was saved, to the bit.
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/contact/src/soft/pair_search.h>
#include <tetskin/threads/thread_pool.h>

#include <vector>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Snapshot = std::vector<unsigned char>;

constexpr int kFrames = 60;

/// Balls and plates that fall into a heap.
struct SavedHeap {
  tetskin::DeformableWorld world;
  std::unique_ptr<SoftContacts> contacts = SoftContacts::add(world).value();
  std::vector<std::unique_ptr<DeformableBody>> bodies;

  explicit SavedHeap(ParallelFor* threads = nullptr) : world(DeformableWorldOptions{btVector3(0, -10, 0), threads}) {
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
    bodies.push_back(DeformableBody::add(world, cage, oneKilogram(options)).value());
    EXPECT_TRUE(contacts->add(bodies.back()->body(), shape).ok());
  }
  void step() { world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240); }
  Snapshot saved() const {
    Snapshot bytes(world.save(nullptr, 0).value());
    const Result<std::size_t> count = world.save(bytes.data(), bytes.size());
    EXPECT_TRUE(count.ok()) << count.status().message;
    return bytes;
  }
  void restore(const Snapshot& bytes) {
    const Status status = world.restore(bytes.data(), bytes.size());
    ASSERT_TRUE(status.ok()) << status.message;
  }
  std::vector<btScalar> motion() const { return motionOf(bodies); }
};

/// A run, by frame.
struct HeapRun {
  std::vector<std::vector<btScalar>> motions;
  std::vector<Snapshot> snapshots;

  explicit HeapRun(SavedHeap& heap) {
    for (int k = 0; k < kFrames; ++k) {
      snapshots.push_back(heap.saved());
      heap.step();
      motions.push_back(heap.motion());
    }
  }
};

void expectToGoOn(SavedHeap& heap, const HeapRun& run, std::size_t from) {
  heap.restore(run.snapshots[from]);
  for (std::size_t k = from; k < run.motions.size(); ++k) {
    const Snapshot saved = heap.saved();
    ASSERT_TRUE(saved == run.snapshots[k]) << "saved at " << from << ", differs at " << k;
    heap.step();
    ASSERT_TRUE(heap.motion() == run.motions[k]) << "saved at " << from << ", differs after " << k;
  }
}

TEST(SnapshotsOfSoftContact, GoOnInTheSameWorld) {
  SavedHeap heap;
  const HeapRun run(heap);
  for (const std::size_t from : {0U, 17U, 40U, 55U}) expectToGoOn(heap, run, from);
}

TEST(SnapshotsOfSoftContact, AmongOtherBodiesAreRefusedAndChangeNothing) {
  SavedHeap heap;
  const Snapshot all = heap.saved();
  for (int k = 0; k < 5; ++k) heap.step();
  heap.contacts->remove(heap.bodies.back()->body());
  const Snapshot before = heap.saved();
  const Status refused = heap.world.restore(all.data(), all.size());
  EXPECT_EQ(refused.code, StatusCode::SnapshotMismatch) << refused.message;
  EXPECT_NE(refused.message.find("contacts among other soft bodies were there"), std::string::npos) << refused.message;
  EXPECT_TRUE(heap.saved() == before);
}

TEST(SnapshotsOfSoftContact, HoldTheSamplesThatTouchedOrPierced) {
  using namespace contact_detail;
  tetskin::DeformableWorld world;
  PairMemory saved, restored;
  saved.touched = {{2, 0}, {5, 3}};
  saved.pierced = {2, 7};
  restored.pierced = {1};
  std::vector<Touch> touches;
  Snapshot bytes(1000);
  bullet_detail::WorldStream out(world, bytes.data(), bytes.size()),
      in(world, static_cast<const unsigned char*>(bytes.data()), bytes.size());
  saved.visitState(out, touches, false);
  restored.visitState(in, touches, false);
  EXPECT_EQ(restored.pierced, saved.pierced);
  ASSERT_EQ(restored.touched.size(), 2U);
  EXPECT_EQ(restored.touched[1].sample, 5);
  EXPECT_EQ(restored.touched[1].age, 3);
}

TEST(SnapshotsOfSoftContact, GoOnInANewWorldOnOtherThreads) {
  SavedHeap heap;
  const HeapRun run(heap);
  ThreadPool threads(2);
  for (const std::size_t from : {25U, 50U}) {
    SavedHeap alone, parallel(&threads);
    expectToGoOn(alone, run, from);
    expectToGoOn(parallel, run, from);
  }
}

}  // namespace
}  // namespace tetskin::test
