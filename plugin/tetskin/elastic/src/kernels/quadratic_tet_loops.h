// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: corotated elasticity of W quadratic tets at a time, with a rotation at each of four points.
// With barycentric weights L_i, their gradients g_i, corners x_i and middles of edges x_ij, the shape functions are
// L_i (2 L_i - 1) and 4 L_i L_j, so that
//   H_i = (4 L_i - 1) x_i + 4 sum_{j != i} L_j x_ij,   F = sum_i H_i g_i^T = sum_{k > 0} (H_k - H_0) g_k^T
//
// A tet whose points are inverted, or rotated far from each other, may be at rest like that, without a stress at any of
// them. It then uses a single rotation R, that of the mean of F, with which it recovers as a linear tet does, and
//   energy = sum over points of V (mu |F - R|^2 + lambda / 2 t^2),   t = mean of tr(R^T F) - 3
// whose gradient is the force, because the energy is stationary in R; for a uniform strain it equals the usual energy.
#pragma once

#include <tetskin/elastic/src/kernels/rest_change.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// The node at the middle of the edge of two corners.
constexpr int kMiddleOf[4][4] = {{0, 4, 5, 6}, {4, 0, 7, 8}, {5, 7, 0, 9}, {6, 8, 9, 0}};

template <class S, int W>
TETSKIN_INLINE void weightsAt(const QuadraticPack<S>& pack, std::size_t point, int lane, Lanes<S, W> weights[4]) {
  for (std::size_t k = 0; k < 3; ++k) weights[k + 1] = wide<S, W>(pack.points[3 * point + k] + lane);
  weights[0] = S(1) - (weights[1] + weights[2] + weights[3]);
}

/// The positions of the nodes relative to the first one: a sum over all of them would lose the digits of a strain.
template <class S, int W>
TETSKIN_INLINE void nodesFromFirst(const QuadraticPack<S>& pack, const S* points, int lane, WideVector<S, W> x[10]) {
  x[0] = vectorsAt<S, W>(points, pack.nodes[0] + lane);
  for (int a = 1; a < 10; ++a) {
    const WideVector<S, W> v = vectorsAt<S, W>(points, pack.nodes[a] + lane);
    x[a] = {v.x - x[0].x, v.y - x[0].y, v.z - x[0].z};
  }
}

/// A quarter of H_i.
/// x  from the first node
template <class S, int W>
TETSKIN_INLINE WideVector<S, W> weightedNodes(const WideVector<S, W> x[10], const Lanes<S, W> weights[4], int i) {
  using V = Lanes<S, W>;
  WideVector<S, W> sum{V{}, V{}, V{}};
  if (i > 0) {
    const V own = weights[i] - S(0.25);
    sum = {own * x[i].x, own * x[i].y, own * x[i].z};
  }
  for (int j = 0; j < 4; ++j) {
    if (j == i) continue;
    const WideVector<S, W>& middle = x[kMiddleOf[i][j]];
    sum = {sum.x + weights[j] * middle.x, sum.y + weights[j] * middle.y, sum.z + weights[j] * middle.z};
  }
  return sum;
}

template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> gradientOf(const QuadraticPack<S>& pack, int lane, const WideVector<S, W> x[10],
                                           const Lanes<S, W> weights[4]) {
  using V = Lanes<S, W>;
  const WideVector<S, W> h0 = weightedNodes<S, W>(x, weights, 0);
  WideMatrix<S, W> f{};
  for (int k = 0; k < 3; ++k) {
    const WideVector<S, W> h = weightedNodes<S, W>(x, weights, k + 1);
    const V from[3] = {S(4) * (h.x - h0.x), S(4) * (h.y - h0.y), S(4) * (h.z - h0.z)};
    for (int j = 0; j < 3; ++j) {
      const V g = wide<S, W>(pack.gradients[3 * k + j] + lane);
      for (int i = 0; i < 3; ++i) f.at[3 * i + j] += from[i] * g;
    }
  }
  return f;
}

/// Calls visit(node, vector) with the sum over i of c_i times carried(g_i), where the gradient of the node's shape
/// function is the sum of c_i g_i.
/// carried  a linear map of vectors
template <class S, int W, class Carried, class Visit>
TETSKIN_INLINE void byShapeGradients(const QuadraticPack<S>& pack, int lane, const Lanes<S, W> weights[4],
                                     Carried&& carried, Visit&& visit) {
  using V = Lanes<S, W>;
  WideVector<S, W> g[4];
  g[0] = {V{}, V{}, V{}};
  for (int k = 0; k < 3; ++k) {
    const S* from = pack.gradients[3 * k] + lane;
    g[k + 1] = carried(S(4) * wide<S, W>(from), S(4) * wide<S, W>(from + kGroup), S(4) * wide<S, W>(from + 2 * kGroup));
    g[0] = {g[0].x - g[k + 1].x, g[0].y - g[k + 1].y, g[0].z - g[k + 1].z};
  }
  for (int i = 0; i < 4; ++i) {
    const V own = weights[i] - S(0.25);
    visit(i, WideVector<S, W>{own * g[i].x, own * g[i].y, own * g[i].z});
    for (int j = i + 1; j < 4; ++j) {
      visit(kMiddleOf[i][j],
            WideVector<S, W>{weights[i] * g[j].x + weights[j] * g[i].x, weights[i] * g[j].y + weights[j] * g[i].y,
                             weights[i] * g[j].z + weights[j] * g[i].z});
    }
  }
}

/// Cosine of half the angle between the rotations of two points above which they are too far apart: 70 degrees. In a
/// tet that is rolled up it is 30; where a tet rests in a wrong state, 90 and more.
template <class S>
constexpr S kApart = S(0.819);

/// The rotation at W points, and S = R^T F.
template <class S, int W>
struct TurnedPoints {
  Quaternions<S, W> q;
  WideMatrix<S, W> r, s;
};

/// 1 if a tet must use a single rotation.
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> lostTets(const TurnedPoints<S, W> at[4]) {
  using V = Lanes<S, W>;
  V nearest = all<S, W>(1), volume = determinantOf<S, W>(at[0].s);
  for (int i = 1; i < 4; ++i) {
    volume = smaller(determinantOf<S, W>(at[i].s), volume);
    for (int j = 0; j < i; ++j) {
      const Quaternions<S, W>&p = at[i].q, &q = at[j].q;
      nearest = smaller(absolute<S, W>(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z), nearest);
    }
  }
  return ((nearest < kApart<S>) | (volume < S(0))) ? all<S, W>(1) : V{};
}

template <class S, int W, class T>
TETSKIN_INLINE void replace(const Lanes<S, W>& where, const T& from, T& to) {
  using V = Lanes<S, W>;
  constexpr std::size_t kBytes = sizeof(V);
  static_assert(sizeof(T) % kBytes == 0);
  V there[sizeof(T) / kBytes], now[sizeof(T) / kBytes];
  ::memcpy(there, &from, sizeof from);
  ::memcpy(now, &to, sizeof to);
  for (std::size_t k = 0; k < sizeof(T) / kBytes; ++k) now[k] = where > S(0) ? there[k] : now[k];
  ::memcpy(&to, now, sizeof to);
}

/// Gives the points of lost tets a single rotation.
/// trace  becomes the mean of tr(S) - 3
template <class S, int W>
TETSKIN_NOINLINE void turnAsAWhole(const Lanes<S, W>& lost, TurnedPoints<S, W> at[4], Lanes<S, W>& trace) {
  using V = Lanes<S, W>;
  WideMatrix<S, W> f[4], mean{};
  for (int point = 0; point < 4; ++point) {
    const auto *r = at[point].r.at, *s = at[point].s.at;
    for (int k = 0; k < 9; ++k) {
      const int i = 3 * (k / 3), j = k % 3;
      const V product = r[i] * s[j] + r[i + 1] * s[3 + j] + r[i + 2] * s[6 + j];
      f[point].at[k] = product;
      mean.at[k] += S(0.25) * product;
    }
  }
  TurnedPoints<S, W> whole = at[0];
  turnToMaximum<S, W>(mean, whole.q, whole.r, whole.s);
  trace = traceOf<S, W>(whole.s) - S(3);
  for (int point = 0; point < 4; ++point) {
    whole.s = transposedProduct<S, W>(whole.r, f[point]);
    replace<S, W>(lost, whole, at[point]);
  }
}

template <class S, int W>
TetFindings<S> quadraticForces(const TetWork<S, QuadraticPack<S>>& work, bool withEnergy) {
  using V = Lanes<S, W>;
  using Pack = QuadraticPack<S>;
  alignas(64) S own[4 * Pack::kNodes * W];
  WideFindings<S, W> findings;
  const WideFrames<S, W> common = commonFrame<S, W>(work);
  for (std::size_t p = work.firstPack; p < work.lastPack; ++p) {
    const Pack& pack = work.packs[p];
    for (int lane = 0; lane < kGroup; lane += W) {
      WideVector<S, W> x[10], force[10];
      nodesFromFirst<S, W>(pack, work.points, lane, x);
      const std::size_t first = 4 * kGroup * Pack::kPoints * p + static_cast<std::size_t>(lane);
      V weights[Pack::kPoints][4];
      const WideFrames<S, W> frame = framesAt<S, W>(work, pack, lane, common);
      WideMatrix<S, W> gradients[Pack::kPoints];
      TurnedPoints<S, W> at[Pack::kPoints];
      for (std::size_t point = 0; point < Pack::kPoints; ++point) {
        weightsAt<S, W>(pack, point, lane, weights[point]);
        at[point].q = quaternions<S, W>(work.rotations + first + 4 * kGroup * point);
        gradients[point] = gradientOf<S, W>(pack, lane, x, weights[point]);
        if (work.changes) {
          gradients[point] =
              elasticPart<S, W>(gradients[point], frame, changesAt<S, W>(work, Pack::kPoints * p + point, lane));
        }
        turnToMaximum<S, W>(deformationGradient<S, W>(gradients[point], frame), at[point].q, at[point].r, at[point].s);
      }
      const V lost = lostTets<S, W>(at);
      V wholeTrace{};
      const bool anyLost = anyAbove<S, W>(lost, S(0.5));
      if (anyLost) turnAsAWhole<S, W>(lost, at, wholeTrace);
      for (WideVector<S, W>& v : force) v = {V{}, V{}, V{}};
      for (std::size_t point = 0; point < Pack::kPoints; ++point) {
        keepRotations<S, W>(at[point].q, work.rotations + first + 4 * kGroup * point,
                            work.assembled + first + 4 * kGroup * point, findings);
        V shear = wide<S, W>(pack.shear + lane), bulk = wide<S, W>(pack.bulk + lane);
        noteVolumes<S, W>(at[point].s, shear, findings);
        WideMatrix<S, W> strain = strainOf<S, W>(at[point].q, at[point].r, gradients[point], frame);
        V trace = traceOf<S, W>(strain);
        if (anyLost) {
          for (int k = 0; k < 9; ++k) at[point].s.at[k] = at[point].s.at[k] - S(k % 4 == 0 ? 1 : 0);
          replace<S, W>(lost, at[point].s, strain);
          replace<S, W>(lost, wholeTrace, trace);
        }
        WideChange<S, W> change{};
        if (work.changes) {
          const std::size_t number = Pack::kPoints * p + point;
          change = changesAt<S, W>(work, number, lane);
          if (flowWhereYielding<S, W>(work, p, number, lane, lost, shear, bulk, strain, change, findings)) {
            trace = lost > S(0) ? trace : traceOf<S, W>(strain);
          }
          noteChange<S, W>(change, work.assembledChanges + kChange * number + static_cast<std::size_t>(lane), findings);
          shear *= change.volume;
          bulk *= change.volume;
        }
        RotatedStress<S, W> stress{at[point].r, stressByLaw<S, W>(work, p, point == 0, lane, lost, strain, trace, shear,
                                                                  bulk, withEnergy, findings)};
        if (work.changes) stress.stress = plusTransposedProduct<S, W>(stress.stress, change.inverse);
        byShapeGradients<S, W>(pack, lane, weights[point], stress, [&](int a, const WideVector<S, W>& v) {
          force[a] = {force[a].x - v.x, force[a].y - v.y, force[a].z - v.z};
        });
      }
      const std::size_t tet = kGroup * p + static_cast<std::size_t>(lane);
      S* const to = work.sums ? own : work.corners + kCorners<Pack> * tet;
      const std::size_t apart = work.sums ? 4 * Pack::kNodes : kCorners<Pack>;
      for (std::size_t a = 0; a < Pack::kNodes; ++a) putPoints<S, W>(force[a], to + 4 * a, apart);
      if (work.sums) addToNodes<S, W>(pack, lane, own, work.sums);
    }
  }
  return findings.all();
}

/// The vectors of the nodes at one of the points.
template <class S, int W>
TETSKIN_INLINE void rotatedShapeGradients(const TetWork<S, QuadraticPack<S>>& work, std::size_t p, std::size_t point,
                                          int lane, const WideFrames<S, W>& common, WideVector<S, W> nodes[10]) {
  using V = Lanes<S, W>;
  using Pack = QuadraticPack<S>;
  const Pack& pack = work.packs[p];
  V weights[4];
  weightsAt<S, W>(pack, point, lane, weights);
  const std::size_t first = kGroup * (Pack::kPoints * p + point);
  const V alpha = alphaOf<S, W>(work, first + static_cast<std::size_t>(lane), [&] {
    WideVector<S, W> x[10];
    nodesFromFirst<S, W>(pack, work.points, lane, x);
    return elasticGradient<S, W>(work, Pack::kPoints * p + point, lane, gradientOf<S, W>(pack, lane, x, weights),
                                 framesAt<S, W>(work, pack, lane, common));
  });
  V mu = S(0.5) * wide<S, W>(pack.shear + lane);
  WideMatrix<S, W> r = rotationOf<S, W>(quaternions<S, W>(work.rotations + 4 * first + lane));
  if (work.changes) changeRest<S, W>(work, Pack::kPoints * p + point, lane, r, mu);
  const V factor = gradientFactor<S, W>(work, p, lane, alpha, mu);
  byShapeGradients<S, W>(
      pack, lane, weights,
      [&](const V& gx, const V& gy, const V& gz) { return rotated<S, W>(r, factor * gx, factor * gy, factor * gz); },
      [&](int a, const WideVector<S, W>& v) { nodes[a] = v; });
}

template <class S, int W>
void quadraticRotatedGradients(const TetWork<S, QuadraticPack<S>>& work) {
  using Pack = QuadraticPack<S>;
  const WideFrames<S, W> common = commonFrame<S, W>(work);
  for (std::size_t p = work.firstPack; p < work.lastPack; ++p) {
    for (int lane = 0; lane < kGroup; lane += W) {
      WideVector<S, W> v[4][10];
      for (std::size_t point = 0; point < 4; ++point) {
        rotatedShapeGradients<S, W>(work, p, point, lane, common, v[point]);
      }
      S* to = work.corners + kCorners<Pack> * (kGroup * p + static_cast<std::size_t>(lane));
      const auto putNext = [&](const WidePoints<S, W>& fourPoints) {
        putPoints<S, W>(fourPoints, to, kCorners<Pack>);
        to += 4;
      };
      for (std::size_t a = 0; a < Pack::kNodes; ++a) {
        putNext({v[0][a].x, v[1][a].x, v[2][a].x, v[3][a].x});
        putNext({v[0][a].y, v[1][a].y, v[2][a].y, v[3][a].y});
        putNext({v[0][a].z, v[1][a].z, v[2][a].z, v[3][a].z});
      }
    }
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
