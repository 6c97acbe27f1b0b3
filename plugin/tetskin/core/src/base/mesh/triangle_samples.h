// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Points spread over a triangle: the corners of the small triangles into which it is cut.
#pragma once

#include <tetskin/core/src/base/mesh/triangle_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {

/// The number of equal parts into which each edge is cut so that none is longer than `spacing`; an integer.
inline double edgeDivisions(const TriangleMesh& mesh, const std::array<int, 3>& triangle, double spacing) {
  assert(spacing > 0.0);
  const TriangleCorners t = cornersOf(mesh, triangle);
  const double longest = std::max({(t[0] - t[1]).norm(), (t[1] - t[2]).norm(), (t[2] - t[0]).norm()});
  return std::ceil(longest / spacing);
}

/// Calls visit(i, j, k) for all points of barycentric weights i, j and k over `divisions`. Cost O(divisions^2)
template <class Visit>
void forEachSample(int divisions, Visit&& visit) {
  assert(divisions > 0);
  for (int i = 0; i <= divisions; ++i) {
    for (int j = 0; i + j <= divisions; ++j) visit(i, j, divisions - i - j);
  }
}

}  // namespace tetskin
