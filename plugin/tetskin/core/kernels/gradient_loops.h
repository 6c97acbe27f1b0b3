// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: the nodes' gradients, and the edges' vectors that follow from them.
#pragma once

#include <tetskin/core/kernels/lanes.h>
#include <tetskin/core/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// Adds one neighbour's part: its position times its factor's three coordinates.
template <class S>
void addNeighbour(const GradientWork<S>& work, std::uint32_t entry, Lanes<S, 4> column[3]) {
  const Lanes<S, 4> x = loadPadded(work.nodes + 4 * static_cast<std::size_t>(work.neighbours[entry]));
  const S* g = work.factors + 3 * static_cast<std::size_t>(entry);
  for (int c = 0; c < 3; ++c) column[c] += x * g[c];
}

template <class S>
void gradients(const GradientWork<S>& given) {
  const GradientWork<S> work = given;
  for (std::size_t n = work.firstNode; n < work.lastNode; ++n) {
    // Two sums, as an addition has to wait for the one before.
    Lanes<S, 4> even[3] = {}, odd[3] = {};
    std::uint32_t e = work.starts[n];
    for (; e + 1 < work.starts[n + 1]; e += 2) {
      addNeighbour(work, e, even);
      addNeighbour(work, e + 1, odd);
    }
    if (e < work.starts[n + 1]) addNeighbour(work, e, even);
    for (int c = 0; c < 3; ++c) storePadded<S>(even[c] + odd[c], work.gradients + 12 * n + 4 * c);
  }
}

template <class S>
S squaredLength(const Lanes<S, 4>& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/// e = (F_i - F_j) (X_j - X_i) / 2, no longer than half the edge's rest length: on a crumpled cage the gradients mean
/// nothing any more, and must not throw the surface out of it.
template <class S>
void edges(const EdgeWork<S>& given) {
  const EdgeWork<S> work = given;
  for (std::size_t i = work.firstEdge; i < work.lastEdge; ++i) {
    const S* a = work.gradients + 12 * static_cast<std::size_t>(work.gradientOf[2 * i]);
    const S* b = work.gradients + 12 * static_cast<std::size_t>(work.gradientOf[2 * i + 1]);
    const S* half = work.halfRest + 4 * i;
    Lanes<S, 4> e = (loadPadded(a) - loadPadded(b)) * half[0];
    for (int c = 1; c < 3; ++c) e += (loadPadded(a + 4 * c) - loadPadded(b + 4 * c)) * half[c];
    const S length = squaredLength<S>(e), limit = half[3];
    if (!(length <= limit)) {
      // Nodes so far apart that the length overflows leave no vector worth having.
      if (length * 0 == 0) {
        e = e * (squareRoot(limit) / squareRoot(length));
      } else {
        e = Lanes<S, 4>{};
      }
    }
    // The fourth number is the rest length, which stays.
    S* out = work.edges + 4 * i;
    for (int k = 0; k < 3; ++k) out[k] = e[k];
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
