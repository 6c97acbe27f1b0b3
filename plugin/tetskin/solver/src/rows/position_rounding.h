// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what of a gap or an offset is visible at a position far from the origin, where the last
// digit of a coordinate is large.
#pragma once

#include <LinearMath/btVector3.h>

#include <algorithm>

namespace tetskin::bullet_detail {

/// Rounding of a position, by axis: far from the origin, a depth of one last digit must not be pushed out.
inline btVector3 roundingOf(const btVector3& position) {
  constexpr btScalar kDigits = 2;  // units of the last one
  return kDigits * SIMD_EPSILON * position.absolute();
}

/// A gap, without a depth below the rounding.
inline btScalar seenGap(btScalar gap, const btVector3& normal, const btVector3& position) {
  return gap < 0 ? std::min(gap + normal.absolute().dot(roundingOf(position)), btScalar(0)) : gap;
}

/// An offset, without the components below the rounding.
inline btVector3 visibleOffset(const btVector3& offset, const btVector3& position) {
  const btVector3 rounding = roundingOf(position);
  btVector3 seen = offset;
  for (int k = 0; k < 3; ++k) {
    if (btFabs(offset[k]) <= rounding[k]) seen[k] = 0;
  }
  return seen;
}

}  // namespace tetskin::bullet_detail
