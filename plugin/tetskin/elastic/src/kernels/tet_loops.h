// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: corotated elasticity of W linear tets at a time, with one deformation gradient each.
#pragma once

#include <tetskin/elastic/src/kernels/rest_change.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// The gradients of points.
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> gradientOf(const TetPack<S>& pack, const S* points, int lane) {
  using V = Lanes<S, W>;
  const WideVector<S, W> x0 = vectorsAt<S, W>(points, pack.nodes[0] + lane);
  V edges[9];
  for (int a = 0; a < 3; ++a) {
    const WideVector<S, W> x = vectorsAt<S, W>(points, pack.nodes[a + 1] + lane);
    edges[a] = x.x - x0.x;
    edges[3 + a] = x.y - x0.y;
    edges[6 + a] = x.z - x0.z;
  }
  WideMatrix<S, W> f;
  for (int j = 0; j < 3; ++j) {
    const V g0 = wide<S, W>(pack.gradients[j] + lane), g1 = wide<S, W>(pack.gradients[3 + j] + lane);
    const V g2 = wide<S, W>(pack.gradients[6 + j] + lane);
    for (int i = 0; i < 3; ++i) f.at[3 * i + j] = edges[3 * i] * g0 + edges[3 * i + 1] * g1 + edges[3 * i + 2] * g2;
  }
  return f;
}

/// R (m g_a) for corners 1 to 3, and for corner 0 the value that makes the sum 0.
template <class S, int W, class Carried>
TETSKIN_INLINE void putCorners(const TetPack<S>& pack, int lane, S* corners, Carried&& carried) {
  using V = Lanes<S, W>;
  WideVector<S, W> first{V{}, V{}, V{}};
  for (int a = 0; a < 3; ++a) {
    const S* g = pack.gradients[3 * a] + lane;
    const WideVector<S, W> v = carried(wide<S, W>(g), wide<S, W>(g + kGroup), wide<S, W>(g + 2 * kGroup));
    first = {first.x - v.x, first.y - v.y, first.z - v.z};
    putPoints<S, W>(v, corners + 4 * (a + 1), kCorners<TetPack<S>>);
  }
  putPoints<S, W>(first, corners, kCorners<TetPack<S>>);
}

template <class S, int W>
TetFindings<S> forces(const TetWork<S, TetPack<S>>& work, bool withEnergy) {
  using V = Lanes<S, W>;
  constexpr std::size_t kScalars = kCorners<TetPack<S>>;
  alignas(64) S own[kScalars * W];
  WideFindings<S, W> findings;
  const WideFrames<S, W> common = commonFrame<S, W>(work);
  for (std::size_t p = work.firstPack; p < work.lastPack; ++p) {
    const TetPack<S>& pack = work.packs[p];
    for (int lane = 0; lane < kGroup; lane += W) {
      const RotatedStress<S, W> stress = rotatedStress<S, W>(
          work, p, p, lane, gradientOf<S, W>(pack, work.points, lane), framesAt<S, W>(work, pack, lane, common),
          wide<S, W>(pack.shear + lane), wide<S, W>(pack.bulk + lane), withEnergy, findings);
      S* const corners = work.sums ? own : work.corners + kScalars * (kGroup * p + static_cast<std::size_t>(lane));
      putCorners<S, W>(pack, lane, corners, [&](const V& gx, const V& gy, const V& gz) {
        const WideVector<S, W> v = stress(gx, gy, gz);
        return WideVector<S, W>{-v.x, -v.y, -v.z};
      });
      if (work.sums) addToNodes<S, W>(pack, lane, own, work.sums);
    }
  }
  return findings.all();
}

template <class S, int W>
void rotatedGradients(const TetWork<S, TetPack<S>>& work) {
  using V = Lanes<S, W>;
  const WideFrames<S, W> common = commonFrame<S, W>(work);
  for (std::size_t p = work.firstPack; p < work.lastPack; ++p) {
    const TetPack<S>& pack = work.packs[p];
    for (int lane = 0; lane < kGroup; lane += W) {
      WideMatrix<S, W> r = rotationOf<S, W>(quaternions<S, W>(work.rotations + 4 * kGroup * p + lane));
      const V alpha = alphaOf<S, W>(work, kGroup * p + static_cast<std::size_t>(lane), [&] {
        return elasticGradient<S, W>(work, p, lane, gradientOf<S, W>(pack, work.points, lane),
                                     framesAt<S, W>(work, pack, lane, common));
      });
      V mu = S(0.5) * wide<S, W>(pack.shear + lane);
      if (work.changes) changeRest<S, W>(work, p, lane, r, mu);
      const V factor = gradientFactor<S, W>(work, p, lane, alpha, mu);
      putCorners<S, W>(pack, lane, work.corners + kCorners<TetPack<S>> * (kGroup * p + static_cast<std::size_t>(lane)),
                       [&](const V& gx, const V& gy, const V& gz) {
                         return rotated<S, W>(r, factor * gx, factor * gy, factor * gz);
                       });
    }
  }
}

/// One point in four lanes.
template <class S>
void sum(const SumWork<S>& work) {
  using V = Lanes<S, 4>;
  const auto cornerAt = [&](std::uint32_t k) {
    V v;
    ::memcpy(&v, work.from + 4 * static_cast<std::size_t>(work.corners[k]), sizeof v);
    return v;
  };
  for (std::size_t slot = work.firstSlot; slot < work.lastSlot; ++slot) {
    V total{};
    for (std::uint32_t k = work.starts[slot]; k < work.starts[slot + 1]; ++k) total += cornerAt(k);
    ::memcpy(work.points + 4 * slot, &total, sizeof total);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
