// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: the way through all runs, a block of vertices at a time.
#pragma once

#include <tetskin/core/kernels/lanes.h>
#include <tetskin/core/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// A number of lanes as a type, to choose code by.
template <int W>
struct Width {
  static constexpr int value = W;
};

/// The next narrower blocks.
constexpr int narrower(int width) {
  return width > 8 ? 8 : width > 4 ? 4 : 1;
}

/// Calls block(width, slot, count) for the slots of one run: short runs in one block as narrow as they are, as most
/// runs of a typical mesh are short; long ones in blocks of the widest registers.
template <int Widest, class Block>
void forBlocks(std::uint32_t first, std::uint32_t last, Block&& block) {
  const std::uint32_t length = last - first;
  if constexpr (Widest > 4) {
    if (length <= 4) return block(Width<4>(), first, static_cast<int>(length));
  }
  if constexpr (Widest > 8) {
    if (length <= 8) return block(Width<8>(), first, static_cast<int>(length));
  }
  for (std::uint32_t slot = first; slot < last; slot += Widest) {
    block(Width<Widest>(), slot, last - slot < Widest ? static_cast<int>(last - slot) : Widest);
  }
}

/// Calls make(tet, run) for every run of the work, then block(tet, width, slot, count) for its slots. What belongs to
/// so many tets is made before their vertices are computed: their loads and the arithmetic on vertices then overlap,
/// and coefficients are read from memory straight into all lanes.
template <int Widest, class Tet, class S, class Make, class Block>
void forAllBlocks(const Work<S>& work, Make&& make, Block&& block) {
  constexpr std::size_t kBatch = 8;
  Tet tets[kBatch];
  for (std::size_t batch = work.firstRun; batch < work.lastRun; batch += kBatch) {
    const std::size_t batchEnd = batch + kBatch < work.lastRun ? batch + kBatch : work.lastRun;
    for (std::size_t r = batch; r < batchEnd; ++r) make(tets[r - batch], r);
    for (std::size_t r = batch; r < batchEnd; ++r) {
      const Tet& tet = tets[r - batch];
      forBlocks<Widest>(work.runs[r].firstSlot, work.runs[r + 1].firstSlot,
                        [&](auto width, std::uint32_t slot, int count) { block(tet, width, slot, count); });
    }
  }
}

/// Writes those of the first `count` points that are chosen, or all of them. Out of the way, and with its arguments in
/// registers, as their addresses would have the loop around it store them each time.
template <class S, int W>
TETSKIN_NOINLINE void storeOneByOne(Lanes<S, W> x, Lanes<S, W> y, Lanes<S, W> z, const bool* chosen, int count,
                                    S* out) {
  const Lanes<S, W> p[3] = {x, y, z};
  for (int i = 0; i < count; ++i) {
    if (chosen && !chosen[i]) continue;
    for (int k = 0; k < 3; ++k) out[3 * i + k] = lane<S, W>(p[k], i);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
