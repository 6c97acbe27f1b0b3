// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: W rows of the matrix at a time.
//
// This work is based on:
//   Stanley C. Eisenstat, "Efficient Implementation of a Class of Preconditioned Conjugate Gradient Methods", SIAM J.
//   Sci. Stat. Comput. 2(1), 1981: a product and a symmetric Gauss-Seidel step together cost no more than a product
#pragma once

#include <tetskin/elastic/src/kernels/wide.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// Symmetric 3x3 blocks times vectors.
template <class S, int W>
TETSKIN_INLINE WideVector<S, W> symmetricTimes(const S* block, const WideVector<S, W>& v) {
  using V = Lanes<S, W>;
  const V xy = wide<S, W>(block + kGroup), xz = wide<S, W>(block + 2 * kGroup), yz = wide<S, W>(block + 4 * kGroup);
  return {wide<S, W>(block) * v.x + xy * v.y + xz * v.z, xy * v.x + wide<S, W>(block + 3 * kGroup) * v.y + yz * v.z,
          xz * v.x + yz * v.y + wide<S, W>(block + 5 * kGroup) * v.z};
}

/// Adds the blocks of entries [first, last) times the points of their neighbours.
template <class S, int W>
TETSKIN_INLINE WideVector<S, W> offDiagonal(const RowWork<S>& work, std::uint32_t first, std::uint32_t last, int lane,
                                            const S* points) {
  using V = Lanes<S, W>;
  WideVector<S, W> total{V{}, V{}, V{}};
  for (std::uint32_t e = first; e < last; ++e) {
    const WideVector<S, W> v = vectorsAt<S, W>(points, work.neighbours + kGroup * static_cast<std::size_t>(e) + lane);
    const S* block = work.blocks + kWideBlock * static_cast<std::size_t>(e) + lane;
    const auto row = [&](int k) {
      return wide<S, W>(block + 3 * k * kGroup) * v.x + wide<S, W>(block + (3 * k + 1) * kGroup) * v.y +
             wide<S, W>(block + (3 * k + 2) * kGroup) * v.z;
    };
    total = {total.x + row(0), total.y + row(1), total.z + row(2)};
  }
  return total;
}

/// The inverses of symmetric positive blocks; 0 where there is no mass. They are computed relative to the trace:
/// products of three entries of the stiffest blocks would exceed float's range.
template <class S, int W>
TETSKIN_INLINE void invert(const Lanes<S, W> block[6], const Lanes<S, W>& mass, S* to) {
  using V = Lanes<S, W>;
  const V trace = block[0] + block[3] + block[5];
  const V unit = S(1) / (trace > S(0) ? trace : all<S, W>(1));
  V d[6];
  for (int k = 0; k < 6; ++k) d[k] = block[k] * unit;
  const V c00 = d[3] * d[5] - d[4] * d[4], c01 = d[2] * d[4] - d[1] * d[5], c02 = d[1] * d[4] - d[2] * d[3];
  const V det = d[0] * c00 + d[1] * c01 + d[2] * c02;
  const auto there = (mass > S(0)) & (det > S(0));
  const V scale = there ? unit / (there ? det : all<S, W>(1)) : V{};
  put<S, W>(c00 * scale, to);
  put<S, W>(c01 * scale, to + kGroup);
  put<S, W>(c02 * scale, to + 2 * kGroup);
  put<S, W>((d[0] * d[5] - d[2] * d[2]) * scale, to + 3 * kGroup);
  put<S, W>((d[1] * d[2] - d[0] * d[4]) * scale, to + 4 * kGroup);
  put<S, W>((d[0] * d[3] - d[1] * d[1]) * scale, to + 5 * kGroup);
}

/// Adds products a b^T of the vectors that a quadratic tet has for two nodes at its four points.
template <class S, int W>
TETSKIN_INLINE void addQuadraticTerm(const RowWork<S>& work, const S* corners, std::uint32_t term, int lane,
                                     Lanes<S, W> sum[9]) {
  const std::uint32_t* indices = work.quadraticTerms + 2 * kGroup * static_cast<std::size_t>(term) + lane;
  WidePoints<S, W> a[3];
  for (std::size_t i = 0; i < 3; ++i) a[i] = pointsAt<S, W>(corners + 4 * i, indices);
  for (std::size_t j = 0; j < 3; ++j) {
    const WidePoints<S, W> b = pointsAt<S, W>(corners + 4 * j, indices + kGroup);
    for (std::size_t i = 0; i < 3; ++i) sum[3 * i + j] += a[i].x * b.x + a[i].y * b.y + a[i].z * b.z + a[i].w * b.w;
  }
}

/// Adds a b^T, over the tets around the edge of a pair of nodes and the points of each tet, with a and b from
/// `corners`.
template <class S, int W>
TETSKIN_INLINE void addTerms(const RowWork<S>& work, const S* corners, std::size_t entry, int lane,
                             Lanes<S, W> sum[9]) {
  using V = Lanes<S, W>;
  for (std::uint32_t term = work.sums[entry]; term < work.sums[entry + 1]; ++term) {
    const std::uint32_t* indices = work.terms + 2 * kGroup * static_cast<std::size_t>(term) + lane;
    const WideVector<S, W> p = vectorsAt<S, W>(corners, indices);
    const WideVector<S, W> q = vectorsAt<S, W>(corners, indices + kGroup);
    const V a[3] = {p.x, p.y, p.z}, b[3] = {q.x, q.y, q.z};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) sum[3 * i + j] += a[i] * b[j];
    }
  }
  for (std::uint32_t term = work.quadraticSums[entry]; term < work.quadraticSums[entry + 1]; ++term) {
    addQuadraticTerm<S, W>(work, corners, term, lane, sum);
  }
}

/// The part of fibres in a block.
template <class S, int W>
TETSKIN_NOINLINE void addFibres(const RowWork<S>& work, std::size_t entry, int lane, Lanes<S, W> block[9]) {
  using V = Lanes<S, W>;
  for (std::size_t layer = 0; layer < work.fibres.count; layer += 2) {
    const S* const along = work.fibres.corners + layer * work.fibres.size;
    V around[9] = {};
    addTerms<S, W>(work, along, entry, lane, block);
    addTerms<S, W>(work, along + work.fibres.size, entry, lane, around);
    const V trace = around[0] + around[4] + around[8];
    for (int i = 0; i < 3; ++i) block[4 * i] += trace;
  }
}

/// The block of a pair of nodes: the sum, over the tets around their edge and the points of each tet, of
///   lambda / mu  a b^T + b a^T + spread (a . b) 1
/// with a and b from `rotatedGradients`. It all follows from the sum of a b^T.
template <class S, int W>
TETSKIN_INLINE void assembleEntry(const RowWork<S>& work, std::size_t entry, int lane, Lanes<S, W> block[9]) {
  using V = Lanes<S, W>;
  V sum[9] = {};
  addTerms<S, W>(work, work.corners, entry, lane, sum);
  const V trace = work.spread * (sum[0] + sum[4] + sum[8]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block[3 * i + j] = work.ratio * sum[3 * i + j] + sum[3 * j + i];
    block[4 * i] += trace;
  }
  if (work.fibres.count > 0) addFibres<S, W>(work, entry, lane, block);
}

/// A mass below the last digits of its stiffness would be lost in the diagonal block, and the matrix would not be
/// positive: it is raised to the fraction `minMass` of the stiffness.
/// trace  of the sum of the row's other blocks
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> effectiveMass(const RowWork<S>& work, const Lanes<S, W>& real, const Lanes<S, W>& trace) {
  const Lanes<S, W> minimum = -work.minMass * trace;
  const auto light = (real > S(0)) & (real < minimum);
  return light ? minimum : real;
}

/// The diagonal block of a row is its mass minus the sum of its off-diagonal blocks, so that a body moves as a whole
/// without resistance.
template <class S, int W>
void assemble(const RowWork<S>& work) {
  using V = Lanes<S, W>;
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      V rowSum[9] = {};
      for (std::size_t e = work.starts[2 * c]; e < work.starts[2 * c + 2]; ++e) {
        V block[9];
        assembleEntry<S, W>(work, e, lane, block);
        S* to = work.blocks + kWideBlock * e + lane;
        for (int k = 0; k < 9; ++k) {
          put<S, W>(block[k], to + k * kGroup);
          rowSum[k] += block[k];
        }
      }
      const V trace = rowSum[0] + rowSum[4] + rowSum[8];
      const V mass = effectiveMass<S, W>(work, wide<S, W>(work.masses + kGroup * c + lane), trace);
      const V d[6] = {mass - rowSum[0], S(-0.5) * (rowSum[1] + rowSum[3]), S(-0.5) * (rowSum[2] + rowSum[6]),
                      mass - rowSum[4], S(-0.5) * (rowSum[5] + rowSum[7]), mass - rowSum[8]};
      for (int k = 0; k < 6; ++k) put<S, W>(d[k], work.diagonal + kWideSymmetric * c + k * kGroup + lane);
      invert<S, W>(d, mass, work.inverse + kWideSymmetric * c + lane);
    }
  }
}

template <class S, int W>
void multiply(const RowWork<S>& work) {
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const auto v = offDiagonal<S, W>(work, work.starts[2 * c], work.starts[2 * c + 2], lane, work.stepPoints);
      std::uint32_t own[W];
      for (int i = 0; i < W; ++i)
        own[i] = static_cast<std::uint32_t>(kGroup * c) + static_cast<std::uint32_t>(lane + i);
      const auto d =
          symmetricTimes<S, W>(work.diagonal + kWideSymmetric * c + lane, vectorsAt<S, W>(work.stepPoints, own));
      put<S, W>({v.x + d.x, v.y + d.y, v.z + d.z}, work.rest + kWideVector * c + lane);
    }
  }
}

/// The same as `multiply` except for rounding, for rows without additions: M v_i + sum_j A_ij (v_j - v_i). In float, an
/// ordinary product resists a translation by the rounding of the stiffness, which may exceed the mass.
template <class S, int W>
void multiplyByDifferences(const RowWork<S>& work) {
  using V = Lanes<S, W>;
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      std::uint32_t slots[W];
      for (int i = 0; i < W; ++i)
        slots[i] = static_cast<std::uint32_t>(kGroup * c) + static_cast<std::uint32_t>(lane + i);
      const auto own = vectorsAt<S, W>(work.stepPoints, slots);
      WideVector<S, W> total{V{}, V{}, V{}};
      V trace{};
      for (std::size_t e = work.starts[2 * c]; e < work.starts[2 * c + 2]; ++e) {
        const auto other =
            vectorsAt<S, W>(work.stepPoints, work.neighbours + kGroup * e + static_cast<std::size_t>(lane));
        const V x = other.x - own.x, y = other.y - own.y, z = other.z - own.z;
        const S* block = work.blocks + kWideBlock * e + lane;
        const auto at = [&](int k) { return wide<S, W>(block + k * kGroup); };
        total = {total.x + (at(0) * x + at(1) * y + at(2) * z), total.y + (at(3) * x + at(4) * y + at(5) * z),
                 total.z + (at(6) * x + at(7) * y + at(8) * z)};
        trace += at(0) + at(4) + at(8);
      }
      const V mass = effectiveMass<S, W>(work, wide<S, W>(work.masses + kGroup * c + lane), trace);
      put<S, W>({mass * own.x + total.x, mass * own.y + total.y, mass * own.z + total.z},
                work.rest + kWideVector * c + lane);
    }
  }
}

template <class S, int W>
void backward(const RowWork<S>& work) {
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const std::size_t at = kWideVector * c + static_cast<std::size_t>(lane);
      const std::size_t block = kWideSymmetric * c + static_cast<std::size_t>(lane);
      const auto z = symmetricTimes<S, W>(work.diagonal + block, wideVector<S, W>(work.residual + at));
      const auto before = wideVector<S, W>(work.direction + at);
      const WideVector<S, W> p{z.x + work.factor * before.x, z.y + work.factor * before.y,
                               z.z + work.factor * before.z};
      put<S, W>(p, work.direction + at);
      const auto u = offDiagonal<S, W>(work, work.starts[2 * c + 1], work.starts[2 * c + 2], lane, work.stepPoints);
      put<S, W>(u, work.rest + at);
      const auto t = symmetricTimes<S, W>(work.inverse + block, {p.x - u.x, p.y - u.y, p.z - u.z});
      put<S, W>(t, work.step + at);
      putPoints<S, W>(t, work.stepPoints + 4 * (kGroup * c + static_cast<std::size_t>(lane)), 4);
    }
  }
}

/// Computes y = (D + L)^-1 v for W rows.
template <class S, int W>
TETSKIN_INLINE WideVector<S, W> solveLower(const RowWork<S>& work, std::size_t c, int lane, const WideVector<S, W>& v) {
  const auto l = offDiagonal<S, W>(work, work.starts[2 * c], work.starts[2 * c + 1], lane, work.lowerPoints);
  const auto y = symmetricTimes<S, W>(work.inverse + kWideSymmetric * c + lane, {v.x - l.x, v.y - l.y, v.z - l.z});
  putPoints<S, W>(y, work.lowerPoints + 4 * (kGroup * c + static_cast<std::size_t>(lane)), 4);
  return y;
}

template <class S, int W>
S forward(const RowWork<S>& work) {
  Lanes<S, W> total{};
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const std::size_t at = kWideVector * c + static_cast<std::size_t>(lane);
      WideVector<S, W> v = wideVector<S, W>(work.rest + at);
      if (work.extra) {
        const auto e = wideVector<S, W>(work.extra + at);
        v = {v.x + e.x, v.y + e.y, v.z + e.z};
      }
      const auto y = solveLower<S, W>(work, c, lane, v), t = wideVector<S, W>(work.step + at);
      const WideVector<S, W> image{t.x + y.x, t.y + y.y, t.z + y.z};
      put<S, W>(image, work.rest + at);
      total += dot<S, W>(wideVector<S, W>(work.direction + at), image);
    }
  }
  return laneSum<S, W>(total);
}

template <class S, int W>
S advance(const RowWork<S>& work) {
  Lanes<S, W> total{};
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const std::size_t at = kWideVector * c + static_cast<std::size_t>(lane);
      const auto x = wideVector<S, W>(work.solution + at), t = wideVector<S, W>(work.step + at);
      put<S, W>({x.x + work.factor * t.x, x.y + work.factor * t.y, x.z + work.factor * t.z}, work.solution + at);
      const auto r = wideVector<S, W>(work.residual + at), a = wideVector<S, W>(work.rest + at);
      const WideVector<S, W> now{r.x - work.factor * a.x, r.y - work.factor * a.y, r.z - work.factor * a.z};
      put<S, W>(now, work.residual + at);
      total += dot<S, W>(now, symmetricTimes<S, W>(work.diagonal + kWideSymmetric * c + lane, now));
    }
  }
  return laneSum<S, W>(total);
}

template <class S, int W>
S lower(const RowWork<S>& work) {
  Lanes<S, W> total{};
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const std::size_t at = kWideVector * c + static_cast<std::size_t>(lane);
      const auto y = solveLower<S, W>(work, c, lane, wideVector<S, W>(work.residual + at));
      put<S, W>(y, work.rest + at);
      total += dot<S, W>(y, symmetricTimes<S, W>(work.diagonal + kWideSymmetric * c + lane, y));
    }
  }
  return laneSum<S, W>(total);
}

template <class S, int W>
void difference(const RowWork<S>& work) {
  using V = Lanes<S, W>;
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const std::size_t at = kWideVector * c + static_cast<std::size_t>(lane);
      auto v = wideVector<S, W>(work.first + at);
      if (work.second) {
        const auto other = wideVector<S, W>(work.second + at);
        v = {v.x - other.x, v.y - other.y, v.z - other.z};
      }
      const auto moves = wide<S, W>(work.masses + kGroup * c + lane) > S(0);
      v = {moves ? v.x : V{}, moves ? v.y : V{}, moves ? v.z : V{}};
      put<S, W>(v, work.step + at);
      putPoints<S, W>(v, work.stepPoints + 4 * (kGroup * c + static_cast<std::size_t>(lane)), 4);
    }
  }
}

template <class S, int W>
S inner(const RowWork<S>& work) {
  Lanes<S, W> total{};
  for (std::size_t c = work.firstChunk; c < work.lastChunk; ++c) {
    for (int lane = 0; lane < kGroup; lane += W) {
      const std::size_t at = kWideVector * c + static_cast<std::size_t>(lane);
      total += dot<S, W>(wideVector<S, W>(work.first + at), wideVector<S, W>(work.second + at));
    }
  }
  return laneSum<S, W>(total);
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
