// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>

namespace tetskin {
namespace {

void expectEachTaskOnce() {
  BulletParallelFor threads;
  for (const std::size_t count : {0, 1, 2, 64, 1000}) {
    std::vector<int> calls(count, 0);
    runTasks(&threads, count, [&](std::size_t k) { ++calls[k]; });
    EXPECT_EQ(calls, std::vector<int>(count, 1));
  }
}

/// Hands out tasks from the last to the first and counts them, as an application's own scheduler may do.
class BackwardsScheduler : public btITaskScheduler {
 public:
  BackwardsScheduler() : btITaskScheduler("backwards") {}
  int getMaxNumThreads() const override { return 1; }
  int getNumThreads() const override { return 1; }
  void setNumThreads(int) override {}
  void parallelFor(int first, int last, int grain, const btIParallelForBody& body) override {
    for (int k = last; k > first; k -= grain, ++pieces) body.forLoop(std::max(first, k - grain), k);
  }
  btScalar parallelSum(int first, int last, int, const btIParallelSumBody& body) override {
    return body.sumLoop(first, last);
  }

  int pieces = 0;
};

class BulletThreads : public testing::Test {
 protected:
  ~BulletThreads() override { btSetTaskScheduler(before); }
  btITaskScheduler* before = btGetTaskScheduler();
};

TEST_F(BulletThreads, RunsSequentiallyWithoutAScheduler) {
  btSetTaskScheduler(nullptr);
  expectEachTaskOnce();
}

TEST_F(BulletThreads, RunsOnBulletsSequentialScheduler) {
  btSetTaskScheduler(btGetSequentialTaskScheduler());
  expectEachTaskOnce();
}

TEST_F(BulletThreads, RunsOnBulletsDefaultSchedulerIfThereIsOne) {
  // This is null where Bullet was built without BT_THREADSAFE.
  const std::unique_ptr<btITaskScheduler> scheduler(btCreateDefaultTaskScheduler());
  btSetTaskScheduler(scheduler.get());
  expectEachTaskOnce();
  btSetTaskScheduler(nullptr);
}

TEST_F(BulletThreads, RunsOnTheApplicationsScheduler) {
  BackwardsScheduler scheduler;
  btSetTaskScheduler(&scheduler);
  expectEachTaskOnce();
  btSetTaskScheduler(nullptr);
  EXPECT_EQ(scheduler.pieces, 2 + 64 + 1000);
}

}  // namespace
}  // namespace tetskin
