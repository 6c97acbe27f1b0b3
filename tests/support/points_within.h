// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <LinearMath/btVector3.h>

#include <random>
#include <vector>

namespace tetskin::test {

/// Points in the cube of this half side, the same points each time.
inline std::vector<btVector3> pointsWithin(btScalar reach, int count) {
  std::mt19937 random(7);
  std::vector<btVector3> points;
  const auto coordinate = [&] { return reach * (btScalar(random()) / btScalar(0x80000000u) - 1); };
  for (int k = 0; k < count; ++k) {
    const btScalar x = coordinate(), y = coordinate(), z = coordinate();
    points.emplace_back(x, y, z);
  }
  return points;
}

}  // namespace tetskin::test
