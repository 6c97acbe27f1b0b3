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
Lanes<S, 4> nodeAt(const Work<S>& work, int node) {
  return loadPadded(work.nodes + 4 * static_cast<std::size_t>(node));
}

/// The vector of a cage edge; the fourth number is its rest length.
template <class S>
Lanes<S, 4> edgeAt(const Work<S>& work, std::uint32_t edge) {
  return loadPadded(work.edges + 4 * static_cast<std::size_t>(edge));
}

/// x(b) of one tet.
template <class S>
struct LinearMap {
  S base[4];
  S slope[3][4];

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) {
    const Run& r = work.runs[run];
    const Lanes<S, 4> last = nodeAt(work, r.nodes[3]);
    storePadded<S>(last + shift, base);
    for (int n = 0; n < 3; ++n) storePadded<S>(nodeAt(work, r.nodes[n]) - last, slope[n]);
  }

  template <class V>
  void positions(const V b[3], V x[3]) const {
    for (int k = 0; k < 3; ++k) x[k] = base[k] + (slope[0][k] * b[0] + slope[1][k] * b[1] + slope[2][k] * b[2]);
  }
};

/// The polynomial of the head of this file.
template <class S>
struct QuadraticMap {
  S base[4];
  S slope[3][4];    ///< of b_k: x_k - x3 + e_k3
  S bend[3][4];     ///< of -b_k b_k: e_k3
  S product[3][4];  ///< of b1 b2, b0 b2, b0 b1: the one without k

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) {
    const Run& r = work.runs[run];
    const Lanes<S, 4> last = nodeAt(work, r.nodes[3]);
    storePadded<S>(last + shift, base);
    const std::uint32_t* ids = work.runEdges + 6 * run;
    const Lanes<S, 4> to3[3] = {edgeAt(work, ids[2]), edgeAt(work, ids[4]), edgeAt(work, ids[5])};
    const Lanes<S, 4> opposite[3] = {edgeAt(work, ids[3]), edgeAt(work, ids[1]), edgeAt(work, ids[0])};
    for (int n = 0; n < 3; ++n) {
      storePadded<S>(nodeAt(work, r.nodes[n]) - last + to3[n], slope[n]);
      storePadded<S>(to3[n], bend[n]);
      storePadded<S>(opposite[n] - to3[(n + 1) % 3] - to3[(n + 2) % 3], product[n]);
    }
  }

  /// x(b) without its base.
  template <class V>
  V fromBase(const V b[3], int k) const {
    return b[0] * (slope[0][k] - bend[0][k] * b[0] + product[2][k] * b[1] + product[1][k] * b[2]) +
           b[1] * (slope[1][k] - bend[1][k] * b[1] + product[0][k] * b[2]) + b[2] * (slope[2][k] - bend[2][k] * b[2]);
  }
  /// Derivative by b_n.
  template <class V>
  V derivative(const V b[3], int n, int k) const {
    const int p = (n + 1) % 3, q = (n + 2) % 3;
    return slope[n][k] - S(2) * bend[n][k] * b[n] + product[q][k] * b[p] + product[p][k] * b[q];
  }
  template <int W>
  void gradient(const Lanes<S, W> b[3], Gradient<S, W>& g) const {
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k) g.column[n][k] = derivative(b, n, k);
    }
  }
};

template <class S, int W>
void loadWeights(const float* const planes[3], std::uint32_t slot, Lanes<S, W> b[3]) {
  for (int k = 0; k < 3; ++k) b[k] = load<S, W>(planes[k] + slot);
}

/// One tet under each kind of surface: positions, and gradients for normals and tangents, of W slots.
template <class S>
struct LinearTet {
  LinearMap<S> map;

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) { map.make(work, run, shift); }

  template <int W>
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    map.positions(b, x);
  }
};

template <class S>
struct QuadraticTet {
  QuadraticMap<S> map;

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) { map.make(work, run, shift); }

  template <int W>
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    for (int k = 0; k < 3; ++k) x[k] = map.base[k] + map.fromBase(b, k);
  }
  template <int W>
  void gradient(const Work<S>& work, std::uint32_t slot, Gradient<S, W>& g) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    map.template gradient<W>(b, g);
  }
};

template <class S>
struct QuadraticTetOutside {
  QuadraticMap<S> map;
  S shortestRest;  ///< of the tet's edges

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) {
    map.make(work, run, shift);
    const std::uint32_t* ids = work.runEdges + 6 * run;
    shortestRest = edgeAt(work, ids[0])[3];
    for (int i = 1; i < 6; ++i) {
      const S rest = edgeAt(work, ids[i])[3];
      if (rest < shortestRest) shortestRest = rest;
    }
  }

  template <int W>
  void closest(const Work<S>& work, std::uint32_t slot, Lanes<S, W> c[3]) const {
    loadWeights<S, W>(work.closest, slot - work.closestBase, c);
  }
  /// What the quadratic part adds is taken, with its derivatives, at the closest point, and continued to first order. A
  /// crumpled cage would carry it far away: it is never longer than the tet's shortest edge at rest.
  template <int W>
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    using V = Lanes<S, W>;
    V b[3], c[3], added[3];
    loadWeights<S, W>(work.weights, slot, b);
    closest<W>(work, slot, c);
    for (int k = 0; k < 3; ++k) {
      V linear = all<S, W>(S(0));
      added[k] = map.fromBase(c, k);
      for (int n = 0; n < 3; ++n) {
        linear += (map.slope[n][k] - map.bend[n][k]) * b[n];
        added[k] += map.derivative(c, n, k) * (b[n] - c[n]);
      }
      added[k] -= linear;
      x[k] = map.base[k] + linear;
    }
    const V length = squareRoots<S, W>(added[0] * added[0] + added[1] * added[1] + added[2] * added[2]);
    const V limit = all<S, W>(shortestRest);
    const V scale = length > limit ? limit / length : all<S, W>(S(1));
    // Nodes so far apart that the length overflows leave no correction worth having.
    for (int k = 0; k < 3; ++k) x[k] += length * 0 == 0 ? added[k] * scale : all<S, W>(S(0));
  }
  template <int W>
  void gradient(const Work<S>& work, std::uint32_t slot, Gradient<S, W>& g) const {
    Lanes<S, W> c[3];
    closest<W>(work, slot, c);
    map.template gradient<W>(c, g);
  }
};

template <class S, int W>
struct WideExtent {
  Lanes<S, W> low[3], high[3];

  explicit WideExtent(const Extent<S>& from) {
    for (int k = 0; k < 3; ++k) {
      low[k] = all<S, W>(from.low[k]);
      high[k] = all<S, W>(from.high[k]);
    }
  }
  /// Of the first `count` lanes only: the others belong to other tets.
  void add(const Lanes<S, W> x[3], int count) {
    const auto counted = laneNumbers<S, W>() < static_cast<S>(count);
    for (int k = 0; k < 3; ++k) {
      low[k] = (counted & (x[k] < low[k])) ? x[k] : low[k];
      high[k] = (counted & (x[k] > high[k])) ? x[k] : high[k];
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

/// One for each width of blocks.
template <class S, int W>
struct WideExtents : WideExtents<S, W == 16  ? 8
                                    : W == 8 ? 4
                                             : 1> {
  using Narrower = WideExtents<S, W == 16 ? 8 : W == 8 ? 4 : 1>;
  WideExtent<S, W> wide;

  explicit WideExtents(const Extent<S>& from) : Narrower(from), wide(from) {}
  void mergeInto(Extent<S>& to) const {
    Narrower::mergeInto(to);
    wide.mergeInto(to);
  }
};
template <class S>
struct WideExtents<S, 1> {
  WideExtent<S, 1> wide;

  explicit WideExtents(const Extent<S>& from) : wide(from) {}
  void mergeInto(Extent<S>& to) const { wide.mergeInto(to); }
};

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

/// The polynomials of so many runs are made before their vertices are computed: their loads and the arithmetic on
/// vertices then overlap, and coefficients are read from memory straight into all lanes.
constexpr std::size_t kBatch = 8;

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

template <class S, int Widest, class TetMap, bool kExtent>
void positionsOf(const Work<S>& given, const S shift[3], S* out, Extent<S>* extent) {
  const Work<S> work = given;  // a copy, which the compiler knows that no store to `out` can change
  const S padded[4] = {shift[0], shift[1], shift[2], S(0)};
  const std::uint32_t end = work.runs[work.lastRun].firstSlot;
  WideExtents<S, Widest> extents(kExtent ? *extent : Extent<S>{});
  TetMap maps[kBatch];
  for (std::size_t batch = work.firstRun; batch < work.lastRun; batch += kBatch) {
    const std::size_t batchEnd = batch + kBatch < work.lastRun ? batch + kBatch : work.lastRun;
    for (std::size_t r = batch; r < batchEnd; ++r) maps[r - batch].make(work, r, loadPadded(padded));
    for (std::size_t r = batch; r < batchEnd; ++r) {
      const TetMap& map = maps[r - batch];
      forBlocks<Widest>(work.runs[r].firstSlot, work.runs[r + 1].firstSlot,
                        [&](auto width, std::uint32_t slot, int count) {
                          constexpr int W = decltype(width)::value;
                          Lanes<S, W> x[3];
                          map.template positions<W>(work, slot, x);
                          if (kExtent) static_cast<WideExtents<S, W>&>(extents).wide.add(x, count);
                          S* to = out + 3 * static_cast<std::size_t>(slot);
                          // Lanes beyond the run's end spill into slots that the next run writes again: cheaper than to
                          // hold back.
                          if (slot + W <= end) {
                            storePoints<S, W>(x, to);
                          } else {
                            storeOneByOne<S, W>(x[0], x[1], x[2], nullptr, count, to);
                          }
                        });
    }
  }
  if (kExtent) extents.mergeInto(*extent);
}

template <class S, int W, class TetMap>
void positionsOf(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  return extent ? positionsOf<S, W, TetMap, true>(work, shift, out, extent)
                : positionsOf<S, W, TetMap, false>(work, shift, out, extent);
}

template <class S, int W>
void positions(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  switch (work.surface) {
    case Surface::Linear:
      return positionsOf<S, W, LinearTet<S>>(work, shift, out, extent);
    case Surface::Quadratic:
      return positionsOf<S, W, QuadraticTet<S>>(work, shift, out, extent);
    case Surface::QuadraticOutside:
      return positionsOf<S, W, QuadraticTetOutside<S>>(work, shift, out, extent);
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
template <class S>
struct LinearDirections {
  S vector[3][4];

  void make(const Work<S>& work, Direction kind, std::size_t run) {
    const Run& r = work.runs[run];
    const Lanes<S, 4> last = nodeAt(work, r.nodes[3]);
    Lanes<S, 4> column[3];
    for (int n = 0; n < 3; ++n) column[n] = nodeAt(work, r.nodes[n]) - last;
    for (int n = 0; n < 3; ++n) {
      const bool isNormal = kind == Direction::Normal;
      storePadded<S>(isNormal ? crossPadded<S>(column[(n + 1) % 3], column[(n + 2) % 3]) : column[n], vector[n]);
    }
  }
  template <int W>
  void sum(const Work<S>&, Direction, std::uint32_t, const Lanes<S, W> m[3], Lanes<S, W> d[3]) const {
    for (int k = 0; k < 3; ++k) d[k] = m[0] * vector[0][k] + m[1] * vector[1][k] + m[2] * vector[2][k];
  }
};

template <class S, class TetMap>
struct QuadraticDirections {
  TetMap map;

  void make(const Work<S>& work, Direction, std::size_t run) { map.make(work, run, Lanes<S, 4>{}); }
  template <int W>
  void sum(const Work<S>& work, Direction kind, std::uint32_t slot, const Lanes<S, W> m[3], Lanes<S, W> d[3]) const {
    Gradient<S, W> g;
    map.template gradient<W>(work, slot, g);
    Lanes<S, W> vector[3][3];
    vectorsFor<S>(kind, g.column, vector);
    for (int k = 0; k < 3; ++k) d[k] = m[0] * vector[0][k] + m[1] * vector[1][k] + m[2] * vector[2][k];
  }
};

/// Shorter than this there is no direction, only rounding; at rest the length is 1.
template <class S>
constexpr S kShortestSquared = S(1e-20);

template <class S, int Widest, class Directions>
void directionsOf(const Work<S>& given, const DirectionFactors& factors, float* out) {
  constexpr S kLargest = S(sizeof(S) == sizeof(float) ? 1e38 : 1e300);
  const Work<S> work = given;
  const DirectionFactors planes = factors;
  const std::uint32_t end = work.runs[work.lastRun].firstSlot;
  Directions tets[kBatch];
  for (std::size_t batch = work.firstRun; batch < work.lastRun; batch += kBatch) {
    const std::size_t batchEnd = batch + kBatch < work.lastRun ? batch + kBatch : work.lastRun;
    for (std::size_t r = batch; r < batchEnd; ++r) tets[r - batch].make(work, planes.kind, r);
    for (std::size_t r = batch; r < batchEnd; ++r) {
      const Directions& tet = tets[r - batch];
      forBlocks<Widest>(work.runs[r].firstSlot, work.runs[r + 1].firstSlot,
                        [&](auto width, std::uint32_t slot, int count) {
                          constexpr int W = decltype(width)::value;
                          Lanes<S, W> m[3], d[3];
                          loadWeights<S, W>(planes.factors, slot, m);
                          tet.template sum<W>(work, planes.kind, slot, m, d);
                          const Lanes<S, W> squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                          const Lanes<S, W> inverse = S(1) / squareRoots<S, W>(squared);
                          Lanes<float, W> unit[3];
                          for (int k = 0; k < 3; ++k) unit[k] = convert<float, S, W>(d[k] * inverse);
                          float* to = out + 3 * static_cast<std::size_t>(slot);
                          if (slot + W <= end && allBetween<S, W>(squared, kShortestSquared<S>, kLargest)) {
                            // No spilling here: the next run may have to leave what is in its slots.
                            storeFirstPoints<W>(unit, count, to);
                          } else {
                            bool chosen[W];
                            for (int i = 0; i < W; ++i) {
                              const S q = lane<S, W>(squared, i);
                              chosen[i] = q > kShortestSquared<S> && q < kLargest;
                            }
                            storeOneByOne<float, W>(unit[0], unit[1], unit[2], chosen, count, to);
                          }
                        });
    }
  }
}

template <class S, int W>
void directions(const Work<S>& work, const DirectionFactors& factors, float* out) {
  switch (work.surface) {
    case Surface::Linear:
      return directionsOf<S, W, LinearDirections<S>>(work, factors, out);
    case Surface::Quadratic:
      return directionsOf<S, W, QuadraticDirections<S, QuadraticTet<S>>>(work, factors, out);
    case Surface::QuadraticOutside:
      return directionsOf<S, W, QuadraticDirections<S, QuadraticTetOutside<S>>>(work, factors, out);
  }
}

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

template <class S, int W>
constexpr Table<S> table() {
  return {positions<S, W>, directions<S, W>, gradients<S>, edges<S>};
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
