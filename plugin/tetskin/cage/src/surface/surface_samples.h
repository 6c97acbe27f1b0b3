// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/surface/surface.h>

#include <array>
#include <vector>

namespace tetskin::cage_detail {

/// Points of a surface that represent all of it. Core's `forEachSample` does not know which points are neighbours, and
/// takes many more on a long thin triangle.
struct SurfaceSamples {
  /// The surface's own points first, then points on those of its triangles that are longer than a step, in rows a step
  /// apart.
  std::vector<Eigen::Vector3d> points;
  std::vector<int> triangleOf;  ///< by point after the surface's own: its triangle
  /// Pairs of points that the surface connects over a distance of at most some two steps.
  std::vector<std::array<int, 2>> steps;
};

/// The number of points is O(points + area / step^2 + length / step).
SurfaceSamples sampleSurface(const Surface& surface, double step);

}  // namespace tetskin::cage_detail
