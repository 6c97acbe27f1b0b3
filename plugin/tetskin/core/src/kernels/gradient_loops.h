// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: the nodes' gradients, and the edge vectors that follow from them.
#pragma once

#include <tetskin/core/src/kernels/points.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// Columns of a gradient, P in a register; the last one may be meaningless.
template <class S, int P>
struct Columns {
  /// Three columns, P in each register.
  static constexpr int kRegisters = (3 + P - 1) / P;
  Points<S, P> item[kRegisters] = {};

  /// Adds one neighbour's contribution: its position times its factor's three coordinates.
  void add(const GradientWork<S>& work, std::size_t entry) {
    const Points<S, P> x = repeated<S, P>(work.nodes + 4 * static_cast<std::size_t>(work.neighbours[entry]));
    const S* factor = work.factors + 3 * entry;
    for (int i = 0; i < kRegisters; ++i) item[i] += x * spread<S, P>(factor + P * i);
  }
};

template <class S, int P>
void gradients(const GradientWork<S>& given) {
  const GradientWork<S> work = given;
  for (std::size_t n = work.firstNode; n < work.lastNode; ++n) {
    // Two sums, because an addition has to wait for the previous one.
    Columns<S, P> even, odd;
    std::size_t e = work.starts[n];
    const std::size_t end = work.starts[n + 1];
    for (; e + 1 < end; e += 2) {
      even.add(work, e);
      odd.add(work, e + 1);
    }
    if (e < end) even.add(work, e);
    S* out = work.gradients + kGradientStride * n;
    for (int i = 0; i < Columns<S, P>::kRegisters; ++i) storeWhole<S, P>(even.item[i] + odd.item[i], out + 4 * P * i);
  }
}

template <class S>
S squaredLength(const Lanes<S, 4>& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/// Writes an edge's vector, no longer than half its rest length: on a crumpled cage the vectors are meaningless, and
/// must not throw the surface out of the cage. The fourth number is the rest length, which stays unchanged.
/// limit  the square of that half
template <class S>
void storeEdge(Lanes<S, 4> e, S limit, S* out) {
  const S length = squaredLength<S>(e);
  if (!(length <= limit)) {
    // If nodes are so far apart that the length overflows, the vector is 0.
    if (length * 0 == 0) {
      e = e * (squareRoot(limit) / squareRoot(length));
    } else {
      e = Lanes<S, 4>{};
    }
  }
  for (int k = 0; k < 3; ++k) out[k] = e[k];
}

/// e = (F_i - F_j) (X_j - X_i) / 2.
template <class S>
void edges(const EdgeWork<S>& given) {
  const EdgeWork<S> work = given;
  for (std::size_t i = work.firstEdge; i < work.lastEdge; ++i) {
    const S* a = work.gradients + kGradientStride * static_cast<std::size_t>(work.gradientOf[2 * i]);
    const S* b = work.gradients + kGradientStride * static_cast<std::size_t>(work.gradientOf[2 * i + 1]);
    const S* half = work.halfRest + 4 * i;
    Lanes<S, 4> e = (loadPadded(a) - loadPadded(b)) * half[0];
    for (int c = 1; c < 3; ++c) e += (loadPadded(a + 4 * c) - loadPadded(b + 4 * c)) * half[c];
    storeEdge<S>(e, half[3], work.edges + 4 * i);
  }
}

/// The vectors of edges of quadratic tets.
template <class S>
void bends(const BendWork<S>& given) {
  const BendWork<S> work = given;
  for (std::size_t i = work.firstEdge; i < work.lastEdge; ++i) {
    Lanes<S, 4> e = {};
    for (std::size_t k = work.starts[i]; k < work.starts[i + 1]; ++k) {
      e += loadPadded(work.nodes + 4 * static_cast<std::size_t>(work.entryNodes[k])) * work.factors[k];
    }
    storeEdge<S>(e, work.halfRest[4 * i + 3], work.edges + 4 * i);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
