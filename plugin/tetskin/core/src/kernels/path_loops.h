// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: normals of the deformed triangles.
#pragma once

#include <tetskin/core/src/kernels/points.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S>
Lanes<S, 4> pointAt(const PathWork<S>& work, std::uint32_t index) {
  return loadPadded(work.points + 4 * static_cast<std::size_t>(index));
}

/// The sum of the cross products of consecutive points of the path, relative to its centre: twice the triangles' area
/// vectors.
template <class S>
Lanes<S, 4> areaVector(const PathWork<S>& work, std::size_t group) {
  // With r turning x y z into y z x, a x b = r(a r(b) - r(a) b); r is linear, so it comes last.
  Lanes<S, 4> forward = {}, backward = {};
  const std::uint32_t* index = work.paths + work.groupPaths[group];
  const std::uint32_t* end = work.paths + work.groupPaths[group + 1];
  if (index == end) return forward;
  const Lanes<S, 4> centre = pointAt(work, work.indices[work.groupPositions[group]]);
  Lanes<S, 4> a = pointAt(work, *index) - centre, turnedA = turned<1, 2, 0, 3, S, 1>(a);
  while (++index != end) {
    const Lanes<S, 4> b = pointAt(work, *index) - centre, turnedB = turned<1, 2, 0, 3, S, 1>(b);
    forward += a * turnedB;
    backward += turnedA * b;
    a = b;
    turnedA = turnedB;
  }
  return turned<1, 2, 0, 3, S, 1>(forward - backward);
}

template <class S>
void writeToPositions(const PathWork<S>& work, std::size_t group, const Lanes<float, 4>& normal) {
  for (std::uint32_t k = work.groupPositions[group]; k < work.groupPositions[group + 1]; ++k) {
    const std::size_t offset = work.indices[k] * work.outStride;
    storeExactly<1>(normal, reinterpret_cast<float*>(reinterpret_cast<char*>(work.out) + offset));
  }
}

/// Tiny or huge sums are scaled first, if they are finite and not 0; otherwise returns false.
template <class S>
TETSKIN_NOINLINE bool normaliseScaled(Lanes<S, 4>& v) {
  S size = 0;
  for (int k = 0; k < 3; ++k) {
    const S absolute = v[k] < 0 ? -v[k] : v[k];
    if (!(absolute * 0 == 0)) return false;
    if (absolute > size) size = absolute;
  }
  if (!(size > 0)) return false;
  for (int k = 0; k < 3; ++k) v[k] /= size;
  const S length = squareRoot(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int k = 0; k < 3; ++k) v[k] /= length;
  return true;
}

/// Squares between this and its inverse are far from the limits of float's range.
constexpr float kOrdinary = 1e-30f;

template <int K, class S>
void writeUnit(const PathWork<S>& work, std::size_t group, const Lanes<S, 4>& sum, const Lanes<S, 4>& inverse) {
  writeToPositions(work, group + K, toFloats<S, 1>(sum * turned<K, K, K, K, S, 1>(inverse)));
}

/// One group at a time, with the same bits as in fours: the order of the vertices determines which groups are processed
/// together.
template <class S>
TETSKIN_NOINLINE void pathNormalsOneByOne(const PathWork<S>& work, std::size_t firstGroup, std::size_t lastGroup) {
  for (std::size_t group = firstGroup; group < lastGroup; ++group) {
    Lanes<S, 4> sum = areaVector(work, group);
    const Lanes<S, 4> four[4] = {sum, sum, sum, sum};
    const Lanes<S, 4> squared = squaredLengths<S, 1>(four);
    if (allBetween<S, 1>(squared, S(kOrdinary), S(1 / kOrdinary))) {
      writeUnit<0>(work, group, sum, inverseSquareRoots<S, 1>(squared));
    } else if (normaliseScaled<S>(sum)) {
      writeToPositions(work, group, toFloats<S, 1>(sum));
    }
  }
}

template <class S>
void pathNormals(const PathWork<S>& given) {
  const PathWork<S> work = given;
  std::size_t group = work.firstGroup;
  for (; group + 4 <= work.lastGroup; group += 4) {
    const Lanes<S, 4> sums[4] = {areaVector(work, group), areaVector(work, group + 1), areaVector(work, group + 2),
                                 areaVector(work, group + 3)};
    const Lanes<S, 4> squared = squaredLengths<S, 1>(sums);
    if (!allBetween<S, 1>(squared, S(kOrdinary), S(1 / kOrdinary))) {
      pathNormalsOneByOne(work, group, group + 4);
      continue;
    }
    const Lanes<S, 4> inverse = inverseSquareRoots<S, 1>(squared);
    writeUnit<0>(work, group, sums[0], inverse);
    writeUnit<1>(work, group, sums[1], inverse);
    writeUnit<2>(work, group, sums[2], inverse);
    writeUnit<3>(work, group, sums[3], inverse);
  }
  pathNormalsOneByOne(work, group, work.lastGroup);
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
