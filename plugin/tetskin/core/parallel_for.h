// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/export.h>

#include <cstddef>
#include <type_traits>

namespace tetskin {

/// Interface through which an application provides threads: the library has none of its own. Derive from it, or use the
/// adapters `BulletParallelFor` (tetskin/bullet/soft_body.h) and `ThreadPool` (tetskin/threads/thread_pool.h).
/// Results are bit-identical for any number of threads, as the work is divided in the same way.
class TETSKIN_CORE_API ParallelFor {
 public:
  /// A reference to a callable void(std::size_t), valid as long as the callable is. Never allocates.
  class Task {
   public:
    /// Wraps a callable; a Task itself is copied instead.
    template <class Callable, class = std::enable_if_t<!std::is_same_v<std::remove_cv_t<Callable>, Task>>>
    explicit Task(Callable& callable)
        : callable_(&callable), call_([](void* c, std::size_t k) { (*static_cast<Callable*>(c))(k); }) {}
    /// Calls the callable with k.
    void operator()(std::size_t k) const { call_(callable_, k); }

   private:
    void* callable_;
    void (*call_)(void*, std::size_t);
  };

  virtual ~ParallelFor() = default;

  /// Calls task(k) once for every k in [0, count), in any order and on any threads, and returns when all have returned.
  /// Tasks do not throw, and do not call `run` again.
  virtual void run(std::size_t count, Task task) = 0;
};

/// Calls callable(k) for every k in [0, count): on `threads`, or on the calling thread if that is null or count is 1.
template <class Callable>
void runTasks(ParallelFor* threads, std::size_t count, Callable&& callable) {
  if (threads && count > 1) {
    threads->run(count, ParallelFor::Task(callable));
  } else {
    for (std::size_t k = 0; k < count; ++k) callable(k);
  }
}

}  // namespace tetskin
