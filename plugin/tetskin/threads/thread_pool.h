// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/parallel_for.h>
#include <tetskin/export.h>

#include <cstddef>
#include <memory>

namespace tetskin {

/// A fixed number of threads that sleep until there is work: for applications that have no scheduler of their own.
///
///     ThreadPool pool;                 // as many threads as the machine has
///     options.threads = &pool;         // of a skin; the pool outlives it
class TETSKIN_THREADS_API ThreadPool : public ParallelFor {
 public:
  /// threadCount  how many work on a `run`, the calling one included; 0: one for each that the machine runs at a time.
  ///              All others are started here. With 1 there are none, and `run` is a loop.
  explicit ThreadPool(std::size_t threadCount = 0);
  /// Waits for the threads to end. No `run` may be under way.
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Including the calling one. Fewer than asked for if the system gave no more.
  std::size_t threadCount() const;

  /// See ParallelFor. The calling thread takes part, and sleeps only while others finish their last task. Allocates
  /// nothing; costs some microseconds to wake the others. Calls from several threads wait for each other; a call from
  /// within a task never returns.
  void run(std::size_t count, Task task) override;

 private:
  class Workers;
  std::unique_ptr<Workers> workers_;
};

}  // namespace tetskin
