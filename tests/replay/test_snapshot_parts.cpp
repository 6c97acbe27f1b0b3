// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Every part of a snapshot matters: with any part from another moment, a run continues differently.
#include "solver/rigid_scene.h"

#include <tetskin/replay/snapshot.h>

#include "solver/deformable_test.h"
#include "support/replays.h"
#include "support/snapshot_parts.h"

namespace tetskin::test {
namespace {

/// All kinds of rigid objects, and a soft body that falls among them.
struct Everything : RigidScene {
  Everything() {
    addFloor();
    addKinds();
    addStack(20);
    addJoints();
    addArm();
    soft = DeformableBody::add(world, smallCageAbove(1)).value();
  }
  void frame() {
    if (++frames % 5 == 0) static_cast<btHingeConstraint&>(*joints[2]).setMotorTargetVelocity(btScalar(frames % 7));
    step();
  }

  int frames = 0;
  std::unique_ptr<DeformableBody> soft;
};

/// The frames after a snapshot; none if it is refused.
std::vector<std::vector<btScalar>> runFrom(const Bytes& snapshot, int frame, Everything& scene) {
  constexpr int kAfter = 30;
  std::vector<std::vector<btScalar>> frames;
  if (!restoreSnapshot(scene.world, snapshot.data(), snapshot.size()).ok()) return frames;
  scene.frames = frame;
  for (int k = 0; k < kAfter; ++k) {
    scene.frame();
    frames.push_back(seen(scene.world));
  }
  return frames;
}

TEST(SnapshotParts, OfOtherMomentsChangeTheRun) {
  constexpr int kLater = 8;
  Everything scene;
  int needed[kParts] = {};
  for (const int frame : {24, 40}) {
    while (scene.frames < frame) scene.frame();
    const Bytes snapshot = saved(scene.world);
    while (scene.frames < frame + kLater) scene.frame();
    const Bytes later = saved(scene.world);
    const auto expected = runFrom(snapshot, frame, scene);
    ASSERT_FALSE(expected.empty());
    for (std::size_t part = 0; part < kParts; ++part) {
      needed[part] += runFrom(withPartOf(later, part, snapshot), frame, scene) != expected;
    }
    EXPECT_TRUE(runFrom(snapshot, frame, scene) == expected) << "after snapshots that fit nothing";
    ASSERT_TRUE(restoreSnapshot(scene.world, later.data(), later.size()).ok());
    scene.frames = frame + kLater;
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    if (part != kContactSearch) {  // see test_snapshots_with_contacts.cpp
      EXPECT_GT(needed[part], 0) << "part " << part;
    }
  }
}

}  // namespace
}  // namespace tetskin::test
