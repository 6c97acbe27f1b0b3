// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs a scene, goes back to snapshots of it, and compares what follows, to the bit.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/solver/deformable_world.h>

#include <cstring>
#include <memory>
#include <vector>

namespace tetskin::test {

using Bytes = std::vector<unsigned char>;

/// A scene whose frames depend on nothing but their number and the world's state.
class ReplayedScene {
 public:
  virtual ~ReplayedScene() = default;
  virtual btDeformableMultiBodyDynamicsWorld& world() = 0;
  /// What the application does in a frame, with the steps of it.
  virtual void frame(int number) = 0;
};

inline Bytes saved(ReplayedScene& scene) {
  const Result<std::size_t> size = saveSnapshot(scene.world(), nullptr, 0);
  EXPECT_TRUE(size.ok()) << size.status().message;
  Bytes bytes(size.ok() ? size.value() : 0);
  const Result<std::size_t> written = saveSnapshot(scene.world(), bytes.data(), bytes.size());
  EXPECT_TRUE(written.ok() && written.value() == bytes.size());
  return bytes;
}

inline void restore(ReplayedScene& scene, const Bytes& snapshot) {
  const Status status = restoreSnapshot(scene.world(), snapshot.data(), snapshot.size());
  EXPECT_TRUE(status.ok()) << status.message;
}

/// What one sees of a world: the bits of all nodes and transforms.
inline std::vector<btScalar> seen(ReplayedScene& scene) {
  std::vector<btScalar> numbers;
  const auto add = [&](const btVector3& v) { numbers.insert(numbers.end(), {v.x(), v.y(), v.z()}); };
  const btCollisionObjectArray& objects = scene.world().getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    for (int i = 0; i < 3; ++i) add(objects[k]->getWorldTransform().getBasis()[i]);
    add(objects[k]->getWorldTransform().getOrigin());
    numbers.push_back(static_cast<btScalar>(objects[k]->getActivationState()));
    const btSoftBody* soft = btSoftBody::upcast(objects[k]);
    for (int n = 0; soft && n < soft->m_nodes.size(); ++n) {
      add(soft->m_nodes[n].m_x);
      add(soft->m_nodes[n].m_v);
    }
  }
  return numbers;
}

struct Frame {
  std::vector<btScalar> seen;
  Bytes snapshot;
};

inline Frame run(ReplayedScene& scene, int number) {
  scene.frame(number);
  return {seen(scene), saved(scene)};
}

inline bool haveSameBits(const std::vector<btScalar>& a, const std::vector<btScalar>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(btScalar)) == 0;
}

/// The frames that follow a snapshot are those that followed when it was made.
/// from  the frame after which it was made
inline void expectFollows(ReplayedScene& scene, const std::vector<Frame>& frames, int from) {
  restore(scene, frames[static_cast<std::size_t>(from)].snapshot);
  EXPECT_EQ(saved(scene), frames[static_cast<std::size_t>(from)].snapshot) << "snapshot of frame " << from;
  for (int f = from + 1; f < static_cast<int>(frames.size()); ++f) {
    const Frame again = run(scene, f);
    ASSERT_TRUE(haveSameBits(again.seen, frames[static_cast<std::size_t>(f)].seen))
        << "frame " << f << " from " << from;
    ASSERT_EQ(again.snapshot, frames[static_cast<std::size_t>(f)].snapshot) << "frame " << f << " from " << from;
  }
}

/// Runs a scene for so many frames, and goes back to some of them: in the same world, in one that was newly built, and
/// in one that has run for other frames.
/// make  -> std::unique_ptr<ReplayedScene>
template <class Make>
void expectReplays(Make&& make, int count, const std::vector<int>& from) {
  const std::unique_ptr<ReplayedScene> first = make();
  std::vector<Frame> frames;
  for (int f = 0; f < count; ++f) frames.push_back(run(*first, f));
  for (const int f : from) {
    SCOPED_TRACE("in the same world");
    expectFollows(*first, frames, f);
  }
  for (const int f : from) {
    SCOPED_TRACE("in a new world");
    const std::unique_ptr<ReplayedScene> second = make();
    expectFollows(*second, frames, f);
    if (testing::Test::HasFatalFailure()) return;
  }
  SCOPED_TRACE("in a world that has run");
  const std::unique_ptr<ReplayedScene> third = make();
  for (int f = 0; f < 5; ++f) third->frame(f);
  expectFollows(*third, frames, from.back());
}

}  // namespace tetskin::test
