// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: unit vectors transformed by the map's gradient.
#pragma once

#include <tetskin/core/src/kernels/tet_maps.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// The three vectors whose weighted sum is a direction. For tangents they are the gradient's columns; for normals they
/// are the cross products of two columns each, which are the columns of the gradient's cofactor matrix in the tet's own
/// coordinates.
template <class S, int P>
void makeVectorsFor(Direction kind, Points<S, P> column[3]) {
  if (kind != Direction::Normal) return;
  const Points<S, P> first = cross<S, P>(column[1], column[2]), second = cross<S, P>(column[2], column[0]);
  column[2] = cross<S, P>(column[0], column[1]);
  column[0] = first;
  column[1] = second;
}

/// The vectors of a linear tet are the same for all its vertices.
template <class S, int P>
struct LinearDirections {
  Points<S, P> vector[3];

  LinearDirections(const Work<S>& work, Direction kind, std::size_t run) {
    const LinearTet<S, 1> tet(work, run);
    Points<S, 1> one[3] = {tet.slope[0], tet.slope[1], tet.slope[2]};
    makeVectorsFor<S, 1>(kind, one);
    for (int n = 0; n < 3; ++n) vector[n] = repeated<S, P>(one[n]);
  }
  Points<S, P> sum(const Work<S>&, Direction, std::size_t, const Weights<S, P>& m) const {
    return vector[0] * m[0] + vector[1] * m[1] + vector[2] * m[2];
  }
};

template <class S, int P, class Tet>
struct QuadraticDirections {
  Tet tet;

  QuadraticDirections(const Work<S>& work, Direction, std::size_t run) : tet(work, run) {}
  Points<S, P> sum(const Work<S>& work, Direction kind, std::size_t slot, const Weights<S, P>& m) const {
    Points<S, P> vector[3];
    tet.gradient(work, slot, vector);
    makeVectorsFor<S, P>(kind, vector);
    return vector[0] * m[0] + vector[1] * m[1] + vector[2] * m[2];
  }
};

/// A shorter sum is only rounding, and has no direction; at rest the length is 1.
template <class S>
constexpr S kMinSquared = S(1e-20);
/// Beyond this the square overflows.
template <class S>
constexpr S kMaxSquared = S(sizeof(S) == sizeof(float) ? 1e38 : 1e300);

/// Writes the first `count` of four times P unit vectors, skipping those without a direction. Not inlined, with its
/// arguments in registers: if their addresses were taken, the loop around the call would store them each time.
template <class S, int P>
TETSKIN_NOINLINE void storeChosen(const S* sums, Points<S, P> squared, Points<S, P> inverse, std::size_t count,
                                  float* out) {
  for (int i = 0; i < atMost<4 * P>(count); ++i) {
    const int lane = i % P * 4 + i / P;
    if (!(squared[lane] > kMinSquared<S> && squared[lane] < kMaxSquared<S>)) continue;
    for (int k = 0; k < 3; ++k) out[3 * i + k] = static_cast<float>(sums[4 * i + k] * inverse[lane]);
  }
}

template <int K, class S, int P>
void storeUnit(const Points<S, P> d[4], const Points<S, P>& inverse, float* out) {
  storeExactly<P>(toFloats<S, P>(d[K] * turned<K, K, K, K, S, P>(inverse)), out + 3 * K * P);
}

/// Writes unit vectors; a direction that has vanished leaves the previous value. sums: count x 4, and memory for 4 P.
template <class S, int P>
void normalise(const S* sums, std::size_t count, float* out) {
  for (std::size_t i = 0; i < count; i += 4 * P) {
    const S* from = sums + 4 * i;
    const Points<S, P> d[4] = {loadPoints<S, P>(from), loadPoints<S, P>(from + 4 * P), loadPoints<S, P>(from + 8 * P),
                               loadPoints<S, P>(from + 12 * P)};
    const Points<S, P> squared = squaredLengths<S, P>(d);
    const Points<S, P> inverse = inverseSquareRoots<S, P>(squared);
    if (count - i >= 4 * P && allBetween<S, P>(squared, kMinSquared<S>, kMaxSquared<S>)) {
      storeUnit<0, S, P>(d, inverse, out + 3 * i);
      storeUnit<1, S, P>(d, inverse, out + 3 * i);
      storeUnit<2, S, P>(d, inverse, out + 3 * i);
      storeUnit<3, S, P>(d, inverse, out + 3 * i);
    } else {
      storeChosen<S, P>(from, squared, inverse, count - i, out + 3 * i);
    }
  }
}

template <class S, int P, class Directions>
void directionsOf(const Work<S>& given, const DirectionPlanes& givenPlanes, float* out) {
  const Work<S> work = given;  // copied, as in positionsOf
  const DirectionPlanes planes = givenPlanes;
  // Runs are short, so their sums are collected, and normalised four registers at a time.
  constexpr std::size_t kMaxSums = 64 * P;
  alignas(64) S sums[4 * (kMaxSums + 4 * P)] = {};
  std::size_t first = work.runs[work.firstRun].firstSlot;  // first slot for which there is a sum
  for (std::size_t r = work.firstRun; r < work.lastRun; ++r) {
    const Directions tet(work, planes.kind, r);
    const std::size_t runEnd = work.runs[r + 1].firstSlot;
    for (std::size_t slot = work.runs[r].firstSlot; slot < runEnd; slot += P) {
      if (slot - first >= kMaxSums) {
        normalise<S, P>(sums, kMaxSums, out + 3 * first);
        ::memcpy(sums, sums + 4 * kMaxSums, 4 * P * sizeof(S));
        first += kMaxSums;
      }
      const Points<S, P> d = tet.sum(work, planes.kind, slot, Weights<S, P>(planes.factors, slot));
      ::memcpy(sums + 4 * (slot - first), &d, sizeof d);
    }
  }
  normalise<S, P>(sums, work.runs[work.lastRun].firstSlot - first, out + 3 * first);
}

template <class S, int P>
void directions(const Work<S>& work, const DirectionPlanes& planes, float* out) {
  switch (work.surface) {
    case Surface::Linear:
      return directionsOf<S, P, LinearDirections<S, P>>(work, planes, out);
    case Surface::Quadratic:
      return directionsOf<S, P, QuadraticDirections<S, P, QuadraticTet<S, P>>>(work, planes, out);
    case Surface::QuadraticOutside:
      return directionsOf<S, P, QuadraticDirections<S, P, QuadraticTetOutside<S, P>>>(work, planes, out);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
