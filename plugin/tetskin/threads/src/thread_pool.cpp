// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/compiler.h>
#include <tetskin/threads/thread_pool.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

namespace tetskin {

namespace {

/// Number of times that this process has come from another one by `fork`, which leaves all threads but the calling one
/// behind.
unsigned forksSoFar() {
  static std::atomic<unsigned> forks{0};
#if defined(__unix__) || defined(__APPLE__)
  [[maybe_unused]] static const int told = pthread_atfork(nullptr, nullptr, [] { ++forks; });
#endif
  return forks.load(std::memory_order_relaxed);
}

/// How long threads look for work, and a caller waits for the end of others' tasks, before they sleep: longer than
/// waking a thread takes, but short, because a thread displaced by another program only ends its task when it gets a
/// core.
constexpr std::chrono::microseconds kSpin{20};

/// Waits up to kSpin for a condition. Returns whether it holds.
template <class Condition>
bool spinUntil(Condition&& holds) {
  // Reading the clock takes longer than a test of the condition.
  constexpr int kLooksPerClock = 16;
  const auto begin = std::chrono::steady_clock::now();
  do {
    for (int k = 0; k < kLooksPerClock; ++k) {
      if (holds()) return true;
      pauseThread();
    }
  } while (std::chrono::steady_clock::now() - begin < kSpin);
  return holds();
}

}  // namespace

/// One `run` at a time. Threads enter an open run, take the next task from a counter, and leave when there is none. The
/// caller closes the run when all tasks are taken, and waits only for threads that have entered.
class ThreadPool::Workers {
 public:
  explicit Workers(std::size_t count) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count) threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
      // The system provides no more threads: the existing ones suffice.
    }
  }

  ~Workers() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_.store(true);
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  std::size_t size() const { return threads_.size(); }
  /// The threads are those of another process: they do not work here, and what they wait on cannot be destroyed.
  bool leftBehind() const { return forks_ != forksSoFar(); }

  void run(std::size_t count, Task task) {
    assert(count > 0 && !threads_.empty());
    const std::lock_guard<std::mutex> one(oneAtATime_);
    assert((state_.load() & (kOpen | kInside)) == 0);
    task_ = task;
    count_ = count;
    next_.store(0, std::memory_order_relaxed);
    state_.store(((state_.load() & kRound) + kOneRound) | kOpen);
    wakeSleepers(count);
    takeTasks();
    if ((state_.fetch_and(~kOpen) & kInside) == 0) return;
    const auto allLeft = [this] { return (state_.load() & kInside) == 0; };
    if (spinUntil(allLeft)) return;
    std::unique_lock<std::mutex> lock(mutex_);
    callerSleeps_.store(true);
    idle_.wait(lock, allLeft);
    callerSleeps_.store(false);
  }

 private:
  // Parts of the state: the number of the run, whether it is open, and how many threads have entered it.
  static constexpr std::uint64_t kInside = 0xFFFF, kOpen = 0x10000, kOneRound = 0x100000000, kRound = ~0xFFFFFFFFull;

  /// Wakes no more threads than there is work for: the caller does at least one task.
  void wakeSleepers(std::size_t count) {
    const std::size_t wanted = std::min(sleeping_.load(), count - 1);
    if (wanted == 0) return;
    { const std::lock_guard<std::mutex> lock(mutex_); }  // those about to sleep then do
    for (std::size_t k = 0; k < wanted; ++k) wake_.notify_one();
  }

  void takeTasks() {
    for (;;) {
      const std::size_t k = next_.fetch_add(1, std::memory_order_relaxed);
      if (k >= count_) return;
      (*task_)(k);
    }
  }

  /// Enters the open run, unless this thread has already been in it.
  bool enter(std::uint64_t& seen) {
    std::uint64_t state = state_.load();
    while ((state & kOpen) != 0 && (state & kRound) != seen) {
      if (!state_.compare_exchange_weak(state, state + 1)) continue;
      seen = state & kRound;
      return true;
    }
    return false;
  }

  void leave() {
    if (((state_.fetch_sub(1) - 1) & (kOpen | kInside)) != 0) return;
    if (!callerSleeps_.load()) return;
    { const std::lock_guard<std::mutex> lock(mutex_); }  // a caller about to sleep then does
    idle_.notify_one();
  }

  void work() {
    std::uint64_t seen = 0;
    while (!ending_.load()) {
      bool entered = spinUntil([&] { return enter(seen) || ending_.load(); }) && !ending_.load();
      if (!entered) {
        std::unique_lock<std::mutex> lock(mutex_);
        ++sleeping_;
        wake_.wait(lock, [&] { return ending_.load() || (entered = enter(seen)); });
        --sleeping_;
      }
      if (!entered) continue;
      takeTasks();
      leave();
    }
  }

  const unsigned forks_ = forksSoFar();
  std::vector<std::thread> threads_;
  std::mutex oneAtATime_;
  // Written while no thread is inside a run.
  std::optional<Task> task_;
  std::size_t count_ = 0;

  std::atomic<std::uint64_t> state_{0};
  std::atomic<std::size_t> next_{0};  ///< first task that has not been taken
  std::mutex mutex_;                  ///< of sleeping threads
  std::condition_variable wake_, idle_;
  std::atomic<std::size_t> sleeping_{0};
  std::atomic<bool> callerSleeps_{false}, ending_{false};
};

ThreadPool::ThreadPool(std::optional<std::size_t> threadCount) {
  assert(!threadCount || *threadCount > 0);
  const std::size_t all = std::max<std::size_t>(1, threadCount.value_or(std::thread::hardware_concurrency()));
  workers_ = std::make_unique<Workers>(all - 1);
}

ThreadPool::~ThreadPool() {
  if (workers_->leftBehind()) (void)workers_.release();
}

std::size_t ThreadPool::threadCount() const {
  return workers_->leftBehind() ? 1 : workers_->size() + 1;
}

void ThreadPool::run(std::size_t count, Task task) {
  if (workers_->size() > 0 && count > 1 && !workers_->leftBehind()) return workers_->run(count, task);
  for (std::size_t k = 0; k < count; ++k) task(k);
}

}  // namespace tetskin
