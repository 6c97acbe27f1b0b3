// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/odd_meshes.h"

#include <tetskin/core/mesh_skin.h>
#include <tetskin/threads/thread_pool.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <ctime>
#include <set>
#include <thread>

#ifdef __unix__
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace tetskin {
namespace {

/// Runs `count` tasks and expects each to run once.
void expectEachTaskOnce(ThreadPool& pool, std::size_t count) {
  std::vector<int> calls(count, 0);  // not atomic, so that sanitizers also detect a task that runs twice as a race
  runTasks(&pool, count, [&](std::size_t k) { ++calls[k]; });
  EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(count));
}

TEST(ThreadPool, RunsEveryTaskOnce) {
  for (const std::size_t threads : {1, 2, 3, 8}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threadCount(), threads);
    for (const std::size_t count : {0, 1, 2, 3, 7, 64, 10000}) expectEachTaskOnce(pool, count);
  }
}

TEST(ThreadPool, RunsMoreTasksOrFewerThanItHasThreads) {
  ThreadPool pool(16);
  for (std::size_t count = 0; count < 40; ++count) expectEachTaskOnce(pool, count);
}

TEST(ThreadPool, ManyRunsInARow) {
  ThreadPool pool(4);
  std::vector<std::size_t> sums(5, 0);
  for (std::size_t round = 0; round < 20000; ++round) {
    runTasks(&pool, sums.size(), [&](std::size_t k) { sums[k] += k + round; });
  }
  for (std::size_t k = 0; k < sums.size(); ++k) EXPECT_EQ(sums[k], 20000 * k + 20000u * 19999 / 2);
}

TEST(ThreadPool, RunsAgainWhenItsThreadsSleep) {
  ThreadPool pool(3);
  for (int round = 0; round < 50; ++round) {
    std::this_thread::sleep_for(std::chrono::microseconds(40 * round));  // shorter and longer than they look for work
    expectEachTaskOnce(pool, 7);
  }
}

TEST(ThreadPool, ACallerSleepsUntilTheLastTaskEnds) {
  ThreadPool pool(2);
  const auto caller = std::this_thread::get_id();
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> started{0};
    std::atomic<bool> ended{false};
    runTasks(&pool, 2, [&](std::size_t) {
      ++started;
      while (started.load() < 2) std::this_thread::yield();
      if (std::this_thread::get_id() == caller) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      ended = true;
    });
    EXPECT_TRUE(ended);
  }
}

TEST(ThreadPool, HasTheMachinesThreadsByDefault) {
  const ThreadPool pool;
  EXPECT_EQ(pool.threadCount(), std::max(1u, std::thread::hardware_concurrency()));
}

TEST(ThreadPool, ThreadsShareTheWork) {
  ThreadPool pool(2);
  std::atomic<int> started{0};
  std::vector<std::thread::id> ids(2);
  // Each task waits for the other: this ends only if both run at the same time.
  runTasks(&pool, 2, [&](std::size_t k) {
    ids[k] = std::this_thread::get_id();
    ++started;
    while (started < 2) std::this_thread::yield();
  });
  EXPECT_NE(ids[0], ids[1]);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), std::this_thread::get_id()), 1);  // the caller also runs tasks
}

TEST(ThreadPool, OneThreadIsTheCaller) {
  ThreadPool pool(1);
  std::set<std::thread::id> ids;
  runTasks(&pool, 10, [&](std::size_t) { ids.insert(std::this_thread::get_id()); });
  EXPECT_EQ(ids, std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST(ThreadPool, CallsFromSeveralThreadsWaitForEachOther) {
  ThreadPool pool(3);
  std::vector<std::vector<int>> calls(4, std::vector<int>(50, 0));
  std::vector<std::thread> callers;
  for (std::vector<int>& mine : calls) {
    callers.emplace_back([&pool, &mine] {
      for (int round = 0; round < 200; ++round) runTasks(&pool, mine.size(), [&](std::size_t k) { ++mine[k]; });
    });
  }
  for (std::thread& caller : callers) caller.join();
  for (const std::vector<int>& mine : calls) EXPECT_EQ(std::count(mine.begin(), mine.end(), 200), 50);
}

TEST(ThreadPool, RunAllocatesNothing) {
  ThreadPool pool(4);
  expectEachTaskOnce(pool, 100);
  std::atomic<int> calls{0};
  const std::size_t before = test::allocationCount();
  for (int round = 0; round < 100; ++round) runTasks(&pool, 30, [&](std::size_t) { ++calls; });
  EXPECT_EQ(test::allocationCount(), before);
  EXPECT_EQ(calls, 3000);
}

TEST(ThreadPool, WaitsWithoutBurningTime) {
  ThreadPool pool(4);
  expectEachTaskOnce(pool, 100);
  const std::clock_t before = std::clock();  // of the whole process
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 0.1);
}

TEST(ThreadPool, MayBeMadeAndDestroyedWithoutWork) {
  for (int k = 0; k < 100; ++k) const ThreadPool pool(4);
}

#ifdef __unix__
TEST(ThreadPool, WorksAloneInAProcessThatWasForked) {
  auto pool = std::make_unique<ThreadPool>(4);
  expectEachTaskOnce(*pool, 100);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));  // its threads sleep, as the destructor would wait for
  const pid_t child = fork();
  if (child == 0) {
    alarm(10);  // ends tasks that would wait forever
    std::vector<int> calls(100, 0);
    runTasks(pool.get(), calls.size(), [&](std::size_t k) { ++calls[k]; });
    bool right = std::count(calls.begin(), calls.end(), 1) == 100 && pool->threadCount() == 1;
    pool.reset();
    pool = std::make_unique<ThreadPool>(2);  // one of this process has threads
    runTasks(pool.get(), calls.size(), [&](std::size_t k) { ++calls[k]; });
    right = right && std::count(calls.begin(), calls.end(), 2) == 100 && pool->threadCount() == 2;
    pool.reset();
    _exit(right ? 0 : 1);
  }
  int ended = -1;
  ASSERT_EQ(waitpid(child, &ended, 0), child);
  EXPECT_EQ(ended, 0);
  EXPECT_EQ(pool->threadCount(), 4u);
  expectEachTaskOnce(*pool, 100);
}
#endif

/// Positions, normals and bounding box of an update of a large mesh with these threads.
struct Update {
  explicit Update(ParallelFor* threads, SkinOptions options) {
    const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
    const TriangleMesh mesh = test::sphere(250, 0.53, Eigen::Vector3d::Constant(0.5));
    options.threads = threads;
    EXPECT_GT(mesh.vertexCount(), 60000u);  // enough for several tasks
    EXPECT_TRUE(skin.bind(cage, mesh, options).ok());
    std::vector<Eigen::Vector3f> nodes;
    for (const Eigen::Vector3d& p : cage.nodes) {
      const Eigen::Vector3d bent = p + 0.2 * Eigen::Vector3d(std::sin(4 * p.y()), p.x() * p.z(), std::cos(3 * p.x()));
      nodes.push_back(bent.cast<float>());
    }
    EXPECT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
  }

  MeshSkin<float> skin;
};

template <class Points>
bool sameBits(const Points& a, const Points& b) {
  return a.size() == b.size() && !a.empty() && std::memcmp(a.data(), b.data(), a.size() * a.strideBytes()) == 0;
}

TEST(ThreadPool, UpdatesHaveTheSameBitsOnAnyNumberOfThreads) {
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
      for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
        SkinOptions options;
        options.interpolation = interpolation;
        options.normals = normals;
        options.order = order;
        const Update serial(nullptr, options);
        for (const std::size_t threads : {1, 2, 5}) {
          ThreadPool pool(threads);
          const Update parallel(&pool, options);
          EXPECT_TRUE(sameBits(parallel.skin.positions(), serial.skin.positions()));
          EXPECT_TRUE(sameBits(parallel.skin.normals(), serial.skin.normals()));
          EXPECT_EQ(parallel.skin.bounds().min(), serial.skin.bounds().min());
          EXPECT_EQ(parallel.skin.bounds().max(), serial.skin.bounds().max());
        }
      }
    }
  }
}

}  // namespace
}  // namespace tetskin
