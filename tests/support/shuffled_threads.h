// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

namespace tetskin::test {

/// Runs tasks on its own threads, in a different order each time.
class ShuffledThreads : public ParallelFor {
 public:
  explicit ShuffledThreads(int threadCount) : threadCount_(threadCount) {}

  void run(std::size_t count, Task task) override {
    ++runs;
    maxTasks = std::max(maxTasks, count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), generator_);
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t k = next++; k < count; k = next++) task(order[k]);
    };
    std::vector<std::thread> threads;
    for (int t = 1; t < threadCount_; ++t) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
  }

  int runs = 0;
  std::size_t maxTasks = 0;

 private:
  int threadCount_;
  std::mt19937 generator_{81};
};

}  // namespace tetskin::test
