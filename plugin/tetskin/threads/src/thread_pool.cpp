// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/threads/thread_pool.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

namespace tetskin {

/// One `run` at a time. Threads take the next task from a counter; sleeping threads are woken by a condition variable.
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
      ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  std::size_t size() const { return threads_.size(); }

  void run(std::size_t count, Task task) {
    assert(count > 0 && !threads_.empty());
    const std::lock_guard<std::mutex> one(oneAtATime_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      task_ = task;
      count_ = count;
      next_.store(0, std::memory_order_relaxed);
      ++round_;
    }
    // No more than there is work for: the caller does at least one task.
    const std::size_t wanted = std::min(threads_.size(), count - 1);
    for (std::size_t k = 0; k < wanted; ++k) wake_.notify_one();
    takeTasks(task, count);
    std::unique_lock<std::mutex> lock(mutex_);
    idle_.wait(lock, [this] { return busy_ == 0; });
    task_.reset();  // a thread that wakes later finds nothing
  }

 private:
  void takeTasks(Task task, std::size_t count) {
    for (;;) {
      const std::size_t k = next_.fetch_add(1, std::memory_order_relaxed);
      if (k >= count) return;
      task(k);
    }
  }

  void work() {
    std::size_t seen = 0;
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return ending_ || (task_ && round_ != seen); });
      if (ending_) return;
      seen = round_;
      const Task task = *task_;
      const std::size_t count = count_;
      ++busy_;
      lock.unlock();
      takeTasks(task, count);
      lock.lock();
      if (--busy_ == 0) idle_.notify_one();
    }
  }

  std::vector<std::thread> threads_;
  std::mutex oneAtATime_;
  std::mutex mutex_;  ///< guards everything below
  std::condition_variable wake_, idle_;
  std::optional<Task> task_;  ///< set during a run
  std::size_t count_ = 0;
  std::size_t round_ = 0;  ///< number of the run
  std::size_t busy_ = 0;   ///< threads in takeTasks, without the caller
  bool ending_ = false;
  std::atomic<std::size_t> next_{0};  ///< first task that has not been taken
};

ThreadPool::ThreadPool(std::optional<std::size_t> threadCount) {
  assert(!threadCount || *threadCount > 0);
  const std::size_t all = std::max<std::size_t>(1, threadCount.value_or(std::thread::hardware_concurrency()));
  workers_ = std::make_unique<Workers>(all - 1);
}

ThreadPool::~ThreadPool() = default;

std::size_t ThreadPool::threadCount() const {
  return workers_->size() + 1;
}

void ThreadPool::run(std::size_t count, Task task) {
  if (workers_->size() > 0 && count > 1) return workers_->run(count, task);
  for (std::size_t k = 0; k < count; ++k) task(k);
}

}  // namespace tetskin
