// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: unit vectors carried by the map's gradient.
#pragma once

#include <tetskin/core/kernels/blocks.h>
#include <tetskin/core/kernels/tet_maps.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

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

template <class S, class Tet>
struct QuadraticDirections {
  Tet tet;

  void make(const Work<S>& work, Direction, std::size_t run) { tet.make(work, run, Lanes<S, 4>{}); }
  template <int W>
  void sum(const Work<S>& work, Direction kind, std::uint32_t slot, const Lanes<S, W> m[3], Lanes<S, W> d[3]) const {
    Gradient<S, W> g;
    tet.template gradient<W>(work, slot, g);
    Lanes<S, W> vector[3][3];
    vectorsFor<S>(kind, g.column, vector);
    for (int k = 0; k < 3; ++k) d[k] = m[0] * vector[0][k] + m[1] * vector[1][k] + m[2] * vector[2][k];
  }
};

/// Shorter than this there is no direction, only rounding; at rest the length is 1.
template <class S>
constexpr S kShortestSquared = S(1e-20);
template <class S>
constexpr S kLargestSquared = S(sizeof(S) == sizeof(float) ? 1e38 : 1e300);

template <class S, int Widest, class Directions>
void directionsOf(const Work<S>& given, const DirectionPlanes& givenPlanes, float* out) {
  const Work<S> work = given;  // copies, as in positionsOf
  const DirectionPlanes planes = givenPlanes;
  const std::uint32_t end = work.runs[work.lastRun].firstSlot;
  forAllBlocks<Widest, Directions>(
      work, [&](Directions& tet, std::size_t run) { tet.make(work, planes.kind, run); },
      [&](const Directions& tet, auto width, std::uint32_t slot, int count) {
        constexpr int W = decltype(width)::value;
        Lanes<S, W> m[3], d[3];
        loadWeights<S, W>(planes.factors, slot, m);
        tet.template sum<W>(work, planes.kind, slot, m, d);
        const Lanes<S, W> squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        const Lanes<S, W> inverse = S(1) / squareRoots<S, W>(squared);
        Lanes<float, W> unit[3];
        for (int k = 0; k < 3; ++k) unit[k] = convert<float, S, W>(d[k] * inverse);
        float* to = out + 3 * static_cast<std::size_t>(slot);
        if (slot + W <= end && allBetween<S, W>(squared, kShortestSquared<S>, kLargestSquared<S>)) {
          // No spilling here: the next run may have to leave what is in its slots.
          storeFirstPoints<W>(unit, count, to);
        } else {
          bool chosen[W];
          for (int i = 0; i < W; ++i) {
            const S q = lane<S, W>(squared, i);
            chosen[i] = q > kShortestSquared<S> && q < kLargestSquared<S>;
          }
          storeOneByOne<float, W>(unit[0], unit[1], unit[2], chosen, count, to);
        }
      });
}

template <class S, int W>
void directions(const Work<S>& work, const DirectionPlanes& planes, float* out) {
  switch (work.surface) {
    case Surface::Linear:
      return directionsOf<S, W, LinearDirections<S>>(work, planes, out);
    case Surface::Quadratic:
      return directionsOf<S, W, QuadraticDirections<S, QuadraticTet<S>>>(work, planes, out);
    case Surface::QuadraticOutside:
      return directionsOf<S, W, QuadraticDirections<S, QuadraticTetOutside<S>>>(work, planes, out);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
