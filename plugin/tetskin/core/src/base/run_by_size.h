// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Tasks of different sizes on threads that do not nest.
#pragma once

#include <tetskin/core/types.h>

#include <cstddef>
#include <vector>

namespace tetskin {

/// A task with more than this fraction of the total work would keep the others waiting.
constexpr double kMaxShareOfTask = 0.25;

/// Calls call(k, inner) for every k: large divisible tasks one by one, with `threads` as `inner`; the others in
/// parallel, with null.
/// sizes        by task: its work, in any unit
/// isDivisible  bool(std::size_t k): whether a task has enough parts for several threads
template <class IsDivisible, class Call>
void runBySize(ParallelFor* threads, const std::vector<std::size_t>& sizes, IsDivisible&& isDivisible, Call&& call) {
  if (!threads) {
    for (std::size_t k = 0; k < sizes.size(); ++k) call(k, threads);
    return;
  }
  double total = 0.0;
  for (const std::size_t size : sizes) total += static_cast<double>(size);
  std::vector<std::size_t> small;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const bool large = static_cast<double>(sizes[k]) > kMaxShareOfTask * total && isDivisible(k);
    if (large || sizes.size() == 1) {
      call(k, threads);
    } else {
      small.push_back(k);
    }
  }
  runTasks(threads, small.size(), [&](std::size_t k) { call(small[k], static_cast<ParallelFor*>(nullptr)); });
}

}  // namespace tetskin
