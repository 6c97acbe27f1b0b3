// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: the loops behind skinning_kernels.h, W vertices at a time. Included once for each instruction set.
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022 (linear)
//   Doug L. James, "Phong Deformation: A Better C0 Interpolant for Embedded Deformation", ACM TOG 39(4), 2020,
//   doi 10.1145/3386569.3392371 (quadratic; the node gradients are this library's own, see quadratic_skinning.h)
//
// With b the weights of a tet's first three nodes, b3 = 1 - b0 - b1 - b2, and e_ij the vector of its edge (i, j):
//   x(b) = x3 + sum_k b_k (x_k - x3) + sum_{i<j} b_i b_j e_ij
// is a polynomial of degree 2 in b, whose ten coefficients are made once a run:
//   constant   x3
//   b_k        x_k - x3 + e_k3
//   b_k b_k    -e_k3
//   b_k b_l    e_kl - e_k3 - e_l3
// Its value and its derivatives are then the same few multiply-adds for every vertex.
#pragma once

#include <tetskin/core/kernels/lanes.h>
#include <tetskin/core/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// Columns of the map's gradient: derivatives by b0, b1 and b2.
template <class S, int W>
struct Gradient {
  Lanes<S, W> column[3][3];  ///< column, coordinate
};

template <class S>
void copyNode(const Work<S>& work, int node, S to[4]) {
  const S* from = work.nodes + 4 * static_cast<std::size_t>(node);
  for (int k = 0; k < 4; ++k) to[k] = from[k];
}

/// x(b) of one tet.
template <class S, int W>
struct LinearMap {
  using V = Lanes<S, W>;
  S base[4];
  S slope[3][4];

  LinearMap(const Work<S>& work, std::size_t run) {
    const Run& r = work.runs[run];
    copyNode(work, r.nodes[3], base);
    for (int n = 0; n < 3; ++n) {
      copyNode(work, r.nodes[n], slope[n]);
      for (int k = 0; k < 4; ++k) slope[n][k] -= base[k];
    }
  }

  void positions(const V b[3], V x[3]) const {
    for (int k = 0; k < 3; ++k) x[k] = base[k] + (slope[0][k] * b[0] + slope[1][k] * b[1] + slope[2][k] * b[2]);
  }
};

/// What the quadratic part adds to it.
template <class S, int W>
struct Correction {
  using V = Lanes<S, W>;
  S slope[3][4];    ///< of b_k
  S square[3][4];   ///< of b_k b_k
  S product[3][4];  ///< of b1 b2, b0 b2, b0 b1: the one without k
  S shortestRest;   ///< of the tet's edges

  Correction(const Work<S>& work, std::size_t run) {
    const std::uint32_t* ids = work.runEdges + 6 * run;
    const S* e[6];
    for (int i = 0; i < 6; ++i) e[i] = work.edges + 4 * static_cast<std::size_t>(ids[i]);
    const S* const to3[3] = {e[2], e[4], e[5]};
    const S* const opposite[3] = {e[3], e[1], e[0]};  // (1,2) (0,2) (0,1)
    for (int n = 0; n < 3; ++n) {
      const int p = (n + 1) % 3, q = (n + 2) % 3;
      for (int k = 0; k < 4; ++k) {
        slope[n][k] = to3[n][k];
        square[n][k] = -to3[n][k];
        product[n][k] = opposite[n][k] - to3[p][k] - to3[q][k];
      }
    }
    shortestRest = e[0][3];
    for (int i = 1; i < 6; ++i) shortestRest = e[i][3] < shortestRest ? e[i][3] : shortestRest;
  }

  V at(const V b[3], int k) const {
    return b[0] * (slope[0][k] + square[0][k] * b[0] + product[2][k] * b[1] + product[1][k] * b[2]) +
           b[1] * (slope[1][k] + square[1][k] * b[1] + product[0][k] * b[2]) +
           b[2] * (slope[2][k] + square[2][k] * b[2]);
  }
  /// Derivative by b_n.
  V derivative(const V b[3], int n, int k) const {
    const int p = (n + 1) % 3, q = (n + 2) % 3;
    return slope[n][k] + S(2) * square[n][k] * b[n] + product[q][k] * b[p] + product[p][k] * b[q];
  }
};

template <class S, int W>
void loadWeights(const float* const planes[3], std::uint32_t slot, Lanes<S, W> b[3]) {
  for (int k = 0; k < 3; ++k) b[k] = load<S, W>(planes[k] + slot);
}

/// One tet under each kind of surface: positions, and gradients for normals and tangents, of W slots.
template <class S, int W>
struct LinearTet {
  LinearMap<S, W> map;

  LinearTet(const Work<S>& work, std::size_t run) : map(work, run) {}

  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    map.positions(b, x);
  }
};

template <class S, int W>
struct QuadraticTet {
  LinearMap<S, W> map;
  Correction<S, W> correction;

  QuadraticTet(const Work<S>& work, std::size_t run) : map(work, run), correction(work, run) {
    // One polynomial: the slopes of both together.
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 4; ++k) correction.slope[n][k] += map.slope[n][k];
    }
  }

  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    for (int k = 0; k < 3; ++k) x[k] = map.base[k] + correction.at(b, k);
  }
  void gradient(const Work<S>& work, std::uint32_t slot, Gradient<S, W>& g) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k) g.column[n][k] = correction.derivative(b, n, k);
    }
  }
};

template <class S, int W>
struct QuadraticTetOutside {
  LinearMap<S, W> map;
  Correction<S, W> correction;

  QuadraticTetOutside(const Work<S>& work, std::size_t run) : map(work, run), correction(work, run) {}

  void closest(const Work<S>& work, std::uint32_t slot, Lanes<S, W> c[3]) const {
    loadWeights<S, W>(work.closest, slot - work.closestBase, c);
  }
  /// The correction and its derivatives are taken at the closest point and continued to first order. A crumpled cage
  /// would carry it far away: it is never longer than the tet's shortest edge at rest.
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    using V = Lanes<S, W>;
    V b[3], c[3], d[3];
    loadWeights<S, W>(work.weights, slot, b);
    closest(work, slot, c);
    for (int k = 0; k < 3; ++k) {
      d[k] = correction.at(c, k);
      for (int n = 0; n < 3; ++n) d[k] += correction.derivative(c, n, k) * (b[n] - c[n]);
    }
    map.positions(b, x);
    const V length = squareRoots<S, W>(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const V limit = all<S, W>(correction.shortestRest);
    const V scale = length > limit ? limit / length : all<S, W>(S(1));
    // Nodes so far apart that the length overflows leave no correction worth having.
    for (int k = 0; k < 3; ++k) x[k] += length * 0 == 0 ? d[k] * scale : all<S, W>(S(0));
  }
  void gradient(const Work<S>& work, std::uint32_t slot, Gradient<S, W>& g) const {
    Lanes<S, W> c[3];
    closest(work, slot, c);
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k) g.column[n][k] = map.slope[n][k] + correction.derivative(c, n, k);
    }
  }
};

/// Lanes 0, 1, 2, ...
template <class S, int W>
Lanes<S, W> laneNumbers() {
  if constexpr (W == 1) {
    return S(0);
  } else {
    Lanes<S, W> v{};
    for (int i = 0; i < W; ++i) v[i] = static_cast<S>(i);
    return v;
  }
}

template <class S, int W>
struct WideExtent {
  using V = Lanes<S, W>;
  V low[3], high[3];

  explicit WideExtent(const Extent<S>& from) {
    for (int k = 0; k < 3; ++k) {
      low[k] = all<S, W>(from.low[k]);
      high[k] = all<S, W>(from.high[k]);
    }
  }
  /// Of the first `count` lanes only: the others belong to other tets.
  void add(const V x[3], int count) {
    const auto counted = laneNumbers<S, W>() < static_cast<S>(count);
    for (int k = 0; k < 3; ++k) {
      low[k] = counted ? smaller<S, W>(x[k], low[k]) : low[k];
      high[k] = counted ? larger<S, W>(x[k], high[k]) : high[k];
    }
  }
  void mergeInto(Extent<S>& to) const {
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < W; ++i) {
        const S a = lane<S, W>(low[k], i), b = lane<S, W>(high[k], i);
        if (a < to.low[k]) to.low[k] = a;
        if (b > to.high[k]) to.high[k] = b;
      }
    }
  }
};

/// Writes those of the first `count` points that `chosen` names, or all of them, to their places.
template <class T, int W>
void scatterPoints(const Lanes<T, W> p[3], std::uint32_t slot, int count, const bool* chosen, const Places& places,
                   T* out) {
  T points[3 * W];
  storePoints<T, W>(p, points);
  for (int i = 0; i < count; ++i) {
    if (chosen && !chosen[i]) continue;
    const std::uint32_t place = places.of ? places.of[slot + i] : slot + i;
    ::memcpy(reinterpret_cast<char*>(out) + place * places.stride, points + 3 * i, 3 * sizeof(T));
  }
}

/// Points that lie side by side in the order of the slots are written W at a time.
template <class T>
bool sideBySide(const Places& places) {
  return !places.of && places.stride == 3 * sizeof(T);
}

template <class S, class T, int W, class TetMap, bool kSideBySide, bool kExtent>
void positionsOf(const Work<S>& given, const S shift[3], T* out, Extent<S>* extent) {
  using V = Lanes<S, W>;
  const Work<S> work = given;  // a copy, which the compiler knows that no store to `out` can change
  const S dx[3] = {shift[0], shift[1], shift[2]};
  WideExtent<S, W> wide(kExtent ? *extent : Extent<S>{});
  const std::uint32_t end = work.runs[work.lastRun].firstSlot;
  for (std::size_t r = work.firstRun; r < work.lastRun; ++r) {
    TetMap map(work, r);
    for (int k = 0; k < 3; ++k) map.map.base[k] += dx[k];
    const std::uint32_t last = work.runs[r + 1].firstSlot;
    for (std::uint32_t slot = work.runs[r].firstSlot; slot < last; slot += W) {
      V x[3];
      map.positions(work, slot, x);
      const int count = last - slot < W ? static_cast<int>(last - slot) : W;
      if (kExtent) wide.add(x, count);
      Lanes<T, W> rounded[3];
      for (int k = 0; k < 3; ++k) rounded[k] = convert<T, S, W>(x[k]);
      // The lanes beyond the run's end spill into places that the next run writes again: cheaper than to hold back.
      if (kSideBySide && slot + W <= end) {
        storePoints<T, W>(rounded, out + 3 * static_cast<std::size_t>(slot));
      } else {
        scatterPoints<T, W>(rounded, slot, count, nullptr, work.places, out);
      }
    }
  }
  if (kExtent) wide.mergeInto(*extent);
}

template <class S, class T, int W, class TetMap>
void positionsOf(const Work<S>& work, const S shift[3], T* out, Extent<S>* extent) {
  if (sideBySide<T>(work.places)) {
    return extent ? positionsOf<S, T, W, TetMap, true, true>(work, shift, out, extent)
                  : positionsOf<S, T, W, TetMap, true, false>(work, shift, out, extent);
  }
  return extent ? positionsOf<S, T, W, TetMap, false, true>(work, shift, out, extent)
                : positionsOf<S, T, W, TetMap, false, false>(work, shift, out, extent);
}

template <class S, class T, int W>
void positions(const Work<S>& work, const S shift[3], T* out, Extent<S>* extent) {
  switch (work.surface) {
    case Surface::Linear:
      return positionsOf<S, T, W, LinearTet<S, W>>(work, shift, out, extent);
    case Surface::Quadratic:
      return positionsOf<S, T, W, QuadraticTet<S, W>>(work, shift, out, extent);
    case Surface::QuadraticOutside:
      return positionsOf<S, T, W, QuadraticTetOutside<S, W>>(work, shift, out, extent);
  }
}

template <class V>
void cross(const V a[3], const V b[3], V c[3]) {
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    c[k] = a[p] * b[q] - a[q] * b[p];
  }
}

/// The three vectors of which a direction is a sum, for normals: the cross products of two columns each, which are the
/// columns of the gradient's cofactor matrix in the tet's own coordinates.
template <class S, class V>
void vectorsFor(Direction kind, const V column[3][3], V vector[3][3]) {
  for (int n = 0; n < 3; ++n) {
    if (kind == Direction::Normal) {
      cross(column[(n + 1) % 3], column[(n + 2) % 3], vector[n]);
    } else {
      for (int k = 0; k < 3; ++k) vector[n][k] = column[n][k];
    }
  }
}

/// Those of a linear tet are the same for all its vertices.
template <class S, int W>
struct LinearDirections {
  S vector[3][3];

  LinearDirections(const Work<S>& work, Direction kind, std::size_t run) {
    const LinearMap<S, W> map(work, run);
    S column[3][3];
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k) column[n][k] = map.slope[n][k];
    }
    vectorsFor<S>(kind, column, vector);
  }
  void sum(const Work<S>&, Direction, std::uint32_t, const Lanes<S, W> m[3], Lanes<S, W> d[3]) const {
    for (int k = 0; k < 3; ++k) d[k] = m[0] * vector[0][k] + m[1] * vector[1][k] + m[2] * vector[2][k];
  }
};

template <class S, int W, class TetMap>
struct QuadraticDirections {
  TetMap map;

  QuadraticDirections(const Work<S>& work, Direction, std::size_t run) : map(work, run) {}
  void sum(const Work<S>& work, Direction kind, std::uint32_t slot, const Lanes<S, W> m[3], Lanes<S, W> d[3]) const {
    Gradient<S, W> g;
    map.gradient(work, slot, g);
    Lanes<S, W> vector[3][3];
    vectorsFor<S>(kind, g.column, vector);
    for (int k = 0; k < 3; ++k) d[k] = m[0] * vector[0][k] + m[1] * vector[1][k] + m[2] * vector[2][k];
  }
};

/// Shorter than this there is no direction, only rounding; at rest the length is 1.
template <class S>
constexpr S kShortestSquared = S(1e-20);

template <class S, int W, class Directions, bool kSideBySide>
void directionsOf(const Work<S>& given, const DirectionFactors& factors, float* out) {
  using V = Lanes<S, W>;
  constexpr S kLargest = S(sizeof(S) == sizeof(float) ? 1e38 : 1e300);
  const Work<S> work = given;
  const DirectionFactors planes = factors;
  for (std::size_t r = work.firstRun; r < work.lastRun; ++r) {
    const Directions tet(work, planes.kind, r);
    const std::uint32_t last = work.runs[r + 1].firstSlot;
    for (std::uint32_t slot = work.runs[r].firstSlot; slot < last; slot += W) {
      V m[3], d[3];
      loadWeights<S, W>(planes.factors, slot, m);
      tet.sum(work, planes.kind, slot, m, d);
      const V squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      const V inverse = S(1) / squareRoots<S, W>(squared);
      Lanes<float, W> unit[3];
      for (int k = 0; k < 3; ++k) unit[k] = convert<float, S, W>(d[k] * inverse);
      const int count = last - slot < W ? static_cast<int>(last - slot) : W;
      const int good = countBetween<S, W>(squared, kShortestSquared<S>, kLargest);
      if (kSideBySide && good == W && count == W) {
        storePoints<float, W>(unit, out + 3 * static_cast<std::size_t>(slot));
      } else {
        bool chosen[W];
        for (int i = 0; i < W; ++i) {
          const S q = lane<S, W>(squared, i);
          chosen[i] = q > kShortestSquared<S> && q < kLargest;
        }
        scatterPoints<float, W>(unit, slot, count, good == W ? nullptr : chosen, work.places, out);
      }
    }
  }
}

template <class S, int W, class Directions>
void directionsOf(const Work<S>& work, const DirectionFactors& factors, float* out) {
  return sideBySide<float>(work.places) ? directionsOf<S, W, Directions, true>(work, factors, out)
                                        : directionsOf<S, W, Directions, false>(work, factors, out);
}

template <class S, int W>
void directions(const Work<S>& work, const DirectionFactors& factors, float* out) {
  switch (work.surface) {
    case Surface::Linear:
      return directionsOf<S, W, LinearDirections<S, W>>(work, factors, out);
    case Surface::Quadratic:
      return directionsOf<S, W, QuadraticDirections<S, W, QuadraticTet<S, W>>>(work, factors, out);
    case Surface::QuadraticOutside:
      return directionsOf<S, W, QuadraticDirections<S, W, QuadraticTetOutside<S, W>>>(work, factors, out);
  }
}

template <class S>
void gradients(const GradientWork<S>& work) {
  for (std::size_t n = work.firstNode; n < work.lastNode; ++n) {
    Lanes<S, 4> column[3] = {};
    for (std::uint32_t e = work.starts[n]; e < work.starts[n + 1]; ++e) {
      const Lanes<S, 4> x = loadPadded(work.nodes + 4 * static_cast<std::size_t>(work.neighbours[e]));
      const S* g = work.factors + 3 * static_cast<std::size_t>(e);
      for (int c = 0; c < 3; ++c) column[c] += x * g[c];
    }
    for (int c = 0; c < 3; ++c) storePadded(column[c], work.gradients + 12 * n + 4 * c);
  }
}

template <class S>
S squaredLength(const Lanes<S, 4>& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/// e = (F_i - F_j) (X_j - X_i) / 2, no longer than half the shorter of the edge's current and rest lengths: on a
/// crumpled cage the gradients mean nothing any more, and must not throw the surface out of it.
template <class S>
void edges(const EdgeWork<S>& work) {
  for (std::size_t i = work.firstEdge; i < work.lastEdge; ++i) {
    const S* a = work.gradients + 12 * static_cast<std::size_t>(work.gradientOf[2 * i]);
    const S* b = work.gradients + 12 * static_cast<std::size_t>(work.gradientOf[2 * i + 1]);
    const S* half = work.halfRest + 4 * i;
    Lanes<S, 4> e = (loadPadded(a) - loadPadded(b)) * half[0];
    for (int c = 1; c < 3; ++c) e += (loadPadded(a + 4 * c) - loadPadded(b + 4 * c)) * half[c];
    const S* p = work.nodes + 4 * static_cast<std::size_t>(work.ends[2 * i]);
    const S* q = work.nodes + 4 * static_cast<std::size_t>(work.ends[2 * i + 1]);
    const S now = squaredLength<S>(loadPadded(q) - loadPadded(p)) / 4;
    const S limit = now < half[3] ? now : half[3];
    const S length = squaredLength<S>(e);
    S scale = 1;
    // Nodes so far apart that the length overflows leave no correction worth having.
    if (!(length <= limit)) scale = length * 0 == 0 ? squareRoot(limit) / squareRoot(length) : S(0);
    S* out = work.edges + 4 * i;
    for (int k = 0; k < 3; ++k) out[k] = scale > 0 ? e[k] * scale : S(0);
  }
}

template <class S, int W>
constexpr Table<S> table() {
  return {positions<S, float, W>, positions<S, double, W>, directions<S, W>, gradients<S>, edges<S>};
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
