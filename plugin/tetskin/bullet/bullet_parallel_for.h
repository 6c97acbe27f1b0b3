// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <LinearMath/btThreads.h>
#include <tetskin/core/parallel_for.h>

#include <cassert>
#include <limits>

namespace tetskin {

/// Runs on the threads of Bullet's task scheduler, the one set by `btSetTaskScheduler`, as `btParallelFor` does.
///
/// Where no scheduler is set it runs sequentially. So it always does with a Bullet that was built without
/// BT_THREADSAFE, such as Debian's: `btCreateDefaultTaskScheduler` returns null there. (A scheduler of the
/// application's own serves nevertheless: what runs on it does not touch Bullet.) `ThreadPool` needs nothing of Bullet.
class BulletParallelFor : public ParallelFor {
 public:
  void run(std::size_t count, Task task) override {
    assert(count <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
    const Body body(task);
    // Not btParallelFor itself: it asserts that there is a scheduler, and, without BT_THREADSAFE, that it is not
    // called.
    btITaskScheduler* scheduler = btGetTaskScheduler();
    if (scheduler) {
      scheduler->parallelFor(0, static_cast<int>(count), 1, body);
    } else {
      body.forLoop(0, static_cast<int>(count));
    }
  }

 private:
  class Body : public btIParallelForBody {
   public:
    explicit Body(Task task) : task_(task) {}
    void forLoop(int first, int last) const override {
      for (int k = first; k < last; ++k) task_(static_cast<std::size_t>(k));
    }

   private:
    Task task_;
  };
};

}  // namespace tetskin
