// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/surface/surface.h>

#include <array>
#include <vector>

namespace tetskin::cage_detail {

/// Points of a surface that stand for all of it. Not those of core's `forEachSample`, which know no neighbours, and of
/// which a long thin triangle takes many more.
struct SurfaceSamples {
  /// Those of the surface first, then points on those of its triangles that are longer than a step, in rows a step
  /// apart.
  std::vector<Eigen::Vector3d> points;
  std::vector<int> triangleOf;            ///< by point beyond the surface's own: its triangle
  std::vector<std::array<int, 2>> steps;  ///< pairs of points that the surface joins on a way of some two steps at most
};

/// Count: O(points + area / step^2 + length / step).
SurfaceSamples sampleSurface(const Surface& surface, double step);

}  // namespace tetskin::cage_detail
