// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to skinning: divides an embedding's runs into pieces of work for kernels, in the same way for any number of
// threads.
#pragma once

#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/kernels/kernel_tables.h>
#include <tetskin/core/src/skinning/skinning.h>
#include <tetskin/core/types.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace tetskin::skin_tasks {

/// Passing work to another thread costs some microseconds, in which this many vertices are skinned.
constexpr std::size_t kSlotsPerTask = 16384;
constexpr std::size_t kMaxTasks = 64;

inline std::size_t taskCount(std::size_t items, std::size_t itemsPerTask = kSlotsPerTask) {
  return std::clamp<std::size_t>(items / itemsPerTask, 1, kMaxTasks);
}

/// The first of a task's items, out of `items`; for task number `tasks`, `items`.
inline std::size_t firstItem(std::size_t items, std::size_t tasks, std::size_t task) {
  assert(tasks > 0 && task <= tasks);
  return items * task / tasks;
}

/// The first run that begins at this slot or later.
inline std::size_t runFrom(const EmbeddingData& embedding, std::size_t slot) {
  assert(!embedding.runs.empty() && slot <= embedding.vertexCount());
  const auto& runs = embedding.runs;
  const auto found = std::partition_point(runs.begin(), runs.end() - 1,
                                          [slot](const EmbeddingData::Run& run) { return run.firstSlot < slot; });
  return static_cast<std::size_t>(found - runs.begin());
}

/// Calls kernel(work, task) for all runs, in pieces that are entirely inside or entirely outside if the surface treats
/// these differently. `work` contains the values that all pieces have in common.
template <class Scalar, class Kernel>
void forAllRuns(const EmbeddingData& embedding, const kernels::Work<Scalar>& work, ParallelFor* threads,
                Kernel&& kernel) {
  const std::size_t tasks = taskCount(embedding.vertexCount());
  runTasks(threads, tasks, [&](std::size_t task) {
    const auto piece = [&](std::size_t first, std::size_t last, kernels::Surface surface) {
      if (first >= last) return;
      kernels::Work<Scalar> part = work;
      part.surface = surface;
      part.firstRun = first;
      part.lastRun = last;
      kernel(part, task);
    };
    const std::size_t first = runFrom(embedding, firstItem(embedding.vertexCount(), tasks, task));
    const std::size_t last = runFrom(embedding, firstItem(embedding.vertexCount(), tasks, task + 1));
    if (work.surface == kernels::Surface::Linear) return piece(first, last, work.surface);
    piece(first, std::min(last, embedding.insideRunCount), kernels::Surface::Quadratic);
    piece(std::max(first, embedding.insideRunCount), last, kernels::Surface::QuadraticOutside);
  });
}

/// The parts of `Work` that depend on an embedding and its nodes.
template <class Scalar>
kernels::Work<Scalar> workFor(const EmbeddingData& embedding, const PackedNodes<Scalar>& nodes) {
  assert(nodes.size() == embedding.nodeCount);
  kernels::Work<Scalar> work;
  work.runs = embedding.runs.data();
  work.nodes = nodes.data();
  for (int k = 0; k < 3; ++k) {
    work.weights[k] = embedding.weights[static_cast<std::size_t>(k)].data();
    work.closest[k] = embedding.closestWeights[static_cast<std::size_t>(k)].data();
  }
  work.closestBase = static_cast<std::uint32_t>(embedding.insideCount);
  return work;
}

/// True if kernels can write to the output directly.
template <class Scalar, class Out>
bool isDirect(PointView<Out> points, VertexOrder order) {
  return std::is_same_v<Scalar, Out> && order == VertexOrder::Sorted && points.strideBytes() == 3 * sizeof(Out);
}

/// Copies to contiguous points of the same type. Each point is moved together with the scalar behind it, which the next
/// one overwrites: one load and one store, where three scalars would take two of each. Therefore `sorted` needs one
/// scalar more, but the points do not.
template <class Scalar>
void placeTightly(const std::uint32_t* slots, const Scalar* sorted, std::size_t first, std::size_t last,
                  Scalar* points) {
  assert(first < last);
  for (std::size_t k = first; k + 1 < last; ++k) {
    std::memcpy(points + 3 * k, sorted + 3 * static_cast<std::size_t>(slots[k]), 4 * sizeof(Scalar));
  }
  const std::size_t k = last - 1;
  std::memcpy(points + 3 * k, sorted + 3 * static_cast<std::size_t>(slots[k]), 3 * sizeof(Scalar));
}

/// Copies to points of four scalars; the last gets any value.
template <class Scalar>
void placePadded(const std::uint32_t* slots, const Scalar* sorted, std::size_t first, std::size_t last,
                 Scalar* padded) {
  const auto copy = [&](std::size_t slot, std::size_t k) {
    std::memcpy(padded + 4 * k, sorted + 3 * slot, 4 * sizeof(Scalar));
  };
  if (!slots) {
    for (std::size_t k = first; k < last; ++k) copy(k, k);
  } else {
    for (std::size_t k = first; k < last; ++k) copy(slots[k], k);
  }
}

/// Copies from slot order, in `scratchSize` scalars, to the order of the output, and to `padded` if it is not null.
/// Reading at random and writing in order is much faster than the reverse: a processor need not wait for values that it
/// reads ahead.
template <class From, class Out>
void place(const EmbeddingData& embedding, const From* sorted, PointView<Out> points, VertexOrder order,
           ParallelFor* threads, From* padded = nullptr) {
  const std::uint32_t* slots = order == VertexOrder::Mesh ? embedding.vertexSlots.data() : nullptr;
  const std::size_t tasks = taskCount(points.size());
  runTasks(threads, tasks, [&](std::size_t task) {
    const std::size_t first = firstItem(points.size(), tasks, task), last = firstItem(points.size(), tasks, task + 1);
    if (padded) placePadded(slots, sorted, first, last, padded);
    if constexpr (std::is_same_v<From, Out>) {
      if (points.strideBytes() == 3 * sizeof(Out)) {
        if (slots) return placeTightly(slots, sorted, first, last, points[0]);
        std::memcpy(points[first], sorted + 3 * first, 3 * (last - first) * sizeof(Out));
        return;
      }
    }
    for (std::size_t k = first; k < last; ++k) {
      const From* from = sorted + 3 * (slots ? static_cast<std::size_t>(slots[k]) : k);
      Out* to = points[k];
      for (int i = 0; i < 3; ++i) to[i] = static_cast<Out>(from[i]);
    }
  });
}

/// Copies back to the order of the slots.
template <class From>
void collect(const EmbeddingData& embedding, PointView<From> points, VertexOrder order, From* sorted) {
  assert(points.size() == embedding.vertexCount());
  for (std::size_t slot = 0; slot < points.size(); ++slot) {
    const std::size_t k = order == VertexOrder::Mesh ? embedding.slotVertices[slot] : slot;
    std::copy_n(points[k], 3, sorted + 3 * slot);
  }
}

/// Writes all positions, and their box, if it is given.
template <class Scalar, class Out>
void skin(const EmbeddingData& embedding, const kernels::Work<Scalar>& work, const PackedNodes<Scalar>& nodes,
          const SkinOutput<Scalar, Out>& output, Box3* bounds, ParallelFor* threads) {
  assert(output.points.size() == embedding.vertexCount());
  if (embedding.runs.empty()) return;
  const Eigen::Matrix<Scalar, 3, 1> shift = nodes.mean() - output.origin;
  constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
  std::array<kernels::Extent<Scalar>, kMaxTasks> extents;
  extents.fill({{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}});
  const bool direct = isDirect<Scalar>(output.points, output.order) && !output.padded;
  std::vector<Scalar> ownScratch(direct || output.scratch ? 0 : scratchSize(output.points.size()));
  Scalar* scratch = output.scratch ? output.scratch : ownScratch.data();
  Scalar* sorted = direct ? reinterpret_cast<Scalar*>(output.points.data()) : scratch;
  const kernels::Table<Scalar>& table = kernels::tableInUse<Scalar>();
  forAllRuns(embedding, work, threads, [&](const kernels::Work<Scalar>& part, std::size_t task) {
    table.positions(part, shift.data(), sorted, bounds ? &extents[task] : nullptr);
  });
  if (!direct) place(embedding, sorted, output.points, output.order, threads, output.padded);
  if (!bounds) return;
  *bounds = Box3();
  for (const kernels::Extent<Scalar>& e : extents) {
    if (!(e.low[0] <= e.high[0])) continue;
    bounds->extend(Eigen::Matrix<Scalar, 3, 1>(e.low).template cast<double>());
    bounds->extend(Eigen::Matrix<Scalar, 3, 1>(e.high).template cast<double>());
  }
}

}  // namespace tetskin::skin_tasks
