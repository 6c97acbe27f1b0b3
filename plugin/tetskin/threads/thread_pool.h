// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>
#include <tetskin/export.h>

#include <cstddef>
#include <memory>
#include <optional>

namespace tetskin {

/// A fixed number of threads, for applications without a scheduler of their own. They sleep until there is work. After
/// a `run` they look for the next one for some microseconds; within a body's step, the next one comes in that time. In
/// a process that was forked while no `run` was in progress, a pool uses only the calling thread, with the same
/// results.
///
///     ThreadPool pool;                 // as many threads as the machine has
///     options.threads = &pool;         // of a skin; the pool outlives it
class TETSKIN_THREADS_API ThreadPool : public ParallelFor {
 public:
  /// Starts the threads.
  /// threadCount  number of threads that work on a `run`, including the calling one, at least 1; not given: one for
  ///              each hardware thread. With 1, none is started, and `run` is a loop.
  explicit ThreadPool(std::optional<std::size_t> threadCount = std::nullopt);
  /// Waits for the threads to end. No `run` may be in progress.
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Number of threads, including the calling one. Less than requested if the system provided fewer; 1 in a process
  /// that was forked.
  std::size_t threadCount() const;

  /// Calls task(k) once for every k in [0, count), see ParallelFor. The calling thread takes part, and waits only while
  /// others finish their last task. Allocates nothing; costs less than a microsecond if the last run has just ended,
  /// otherwise some microseconds to wake the others. Calls from several threads wait for each other; a call from within
  /// a task never returns.
  void run(std::size_t count, Task task) override;

 private:
  class Workers;
  std::unique_ptr<Workers> workers_;
};

}  // namespace tetskin
