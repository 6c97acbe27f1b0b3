// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/threads/thread_pool.h>

#include "replay/replay_scenes.h"
#include "support/instruction_sets.h"

namespace tetskin::test {
namespace {

std::uint64_t hashAfter(int frames, const std::string& name, ParallelFor* threads) {
  DeformableWorldOptions options;
  options.deterministic = true;
  options.threads = threads;
  const auto scene = ReplayScene::create(name, options);
  for (int frame = 0; frame < frames; ++frame) scene->step(frame);
  return stateHash(scene->world());
}

TEST(DeterministicScenes, HaveTheSameBitsWithAllKernelsAndAnyNumberOfThreads) {
  ThreadPool pool(3);
  const std::uint64_t expected = hashAfter(40, "changing", nullptr);
  onEachInstructionSet([&] {
    EXPECT_EQ(hashAfter(40, "changing", nullptr), expected);
    EXPECT_EQ(hashAfter(40, "changing", &pool), expected) << "three threads";
  });
}

}  // namespace
}  // namespace tetskin::test
