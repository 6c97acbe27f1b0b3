// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <string>

namespace tetskin::io {

/// Describes the first point that a surface cannot follow, as the rest of a sentence about it; empty if all points are
/// finite and not beyond Limits::kMaxCoordinate.
inline std::string coordinateFault(PointView<const double> points) {
  const std::size_t first = firstUnusable(points);
  if (first == points.size()) return {};
  return firstNonFinite(PointView<const double>(points[first], 1)) == 0
             ? " has a coordinate that is not finite; correct it"
             : " has a coordinate beyond 1e18; is the file damaged? Correct it, or scale the model";
}
inline std::string coordinateFault(const Eigen::Vector3d& point) {
  return coordinateFault(PointView<const double>(point.data(), 1));
}

}  // namespace tetskin::io
