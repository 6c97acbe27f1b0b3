// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs a scene, goes back to snapshots of it, and compares the following frames, to the bit.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/solver/deformable_world.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "support/rigids.h"

namespace tetskin::test {

using Bytes = std::vector<unsigned char>;

/// A scene whose frames depend on nothing but their number and the world's state.
class ReplayedScene {
 public:
  virtual ~ReplayedScene() = default;
  virtual btDeformableMultiBodyDynamicsWorld& world() = 0;
  /// The application's actions in a frame, including its steps.
  virtual void frame(int number) = 0;
};

inline Bytes saved(const btDeformableMultiBodyDynamicsWorld& world) {
  const Result<std::size_t> size = saveSnapshot(world, nullptr, 0);
  EXPECT_TRUE(size.ok()) << size.status().message;
  Bytes bytes(size.ok() ? size.value() : 0);
  const Result<std::size_t> written = saveSnapshot(world, bytes.data(), bytes.size());
  EXPECT_TRUE(written.ok() && written.value() == bytes.size());
  return bytes;
}
inline Bytes saved(ReplayedScene& scene) {
  return saved(scene.world());
}

inline Status restored(btDeformableMultiBodyDynamicsWorld& world, const Bytes& snapshot) {
  return restoreSnapshot(world, snapshot.data(), snapshot.size());
}
inline void restore(ReplayedScene& scene, const Bytes& snapshot) {
  const Status status = restored(scene.world(), snapshot);
  EXPECT_TRUE(status.ok()) << status.message;
}
/// Restoring fails so, and changes nothing.
inline void expectRefused(btDeformableMultiBodyDynamicsWorld& world, const Bytes& snapshot, StatusCode code,
                          const std::string& named) {
  const Bytes before = saved(world);
  const Status status = restored(world, snapshot);
  EXPECT_EQ(status.code, code) << status.message;
  EXPECT_NE(status.message.find(named), std::string::npos) << status.message;
  EXPECT_EQ(saved(world), before);
}

inline std::vector<btScalar> seen(ReplayedScene& scene) {
  return seen(scene.world());
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
/// most  frames that are compared
inline void expectFollows(ReplayedScene& scene, const std::vector<Frame>& frames, int from, int most = 1000) {
  restore(scene, frames[static_cast<std::size_t>(from)].snapshot);
  EXPECT_EQ(saved(scene), frames[static_cast<std::size_t>(from)].snapshot) << "snapshot of frame " << from;
  for (int f = from + 1; f < std::min(static_cast<int>(frames.size()), from + 1 + most); ++f) {
    const Frame again = run(scene, f);
    ASSERT_TRUE(haveSameBits(again.seen, frames[static_cast<std::size_t>(f)].seen))
        << "frame " << f << " from " << from;
    ASSERT_EQ(again.snapshot, frames[static_cast<std::size_t>(f)].snapshot) << "frame " << f << " from " << from;
  }
}

/// Runs a scene for this many frames, and goes back to some of them: in the same world, in a newly built one, and in
/// one that has run for other frames.
/// make  -> std::unique_ptr<ReplayedScene>
/// makeOther  the same for the new worlds, which may differ in settings that change no bit
template <class Make, class MakeOther>
void expectReplays(Make&& make, MakeOther&& makeOther, int count, const std::vector<int>& from, int most = 1000) {
  const std::unique_ptr<ReplayedScene> first = make();
  std::vector<Frame> frames;
  for (int f = 0; f < count; ++f) frames.push_back(run(*first, f));
  for (const int f : from) {
    SCOPED_TRACE("in the same world");
    expectFollows(*first, frames, f, most);
  }
  for (const int f : from) {
    SCOPED_TRACE("in a new world");
    const std::unique_ptr<ReplayedScene> second = makeOther();
    expectFollows(*second, frames, f, most);
    if (testing::Test::HasFatalFailure()) return;
  }
  SCOPED_TRACE("in a world that has run");
  const std::unique_ptr<ReplayedScene> third = makeOther();
  for (int f = 0; f < 5; ++f) third->frame(f);
  expectFollows(*third, frames, from.back(), most);
}
template <class Make>
void expectReplays(Make&& make, int count, const std::vector<int>& from, int most = 1000) {
  expectReplays(make, make, count, from, most);
}

}  // namespace tetskin::test
