// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace tetskin::cage_detail {

/// Where a straight way crosses a triangle.
struct Crossing {
  double share = std::numeric_limits<double>::quiet_NaN();  ///< of the way; not a number where it passes by
  bool leaves = false;                                      ///< it goes the way of the triangle's normal

  bool within() const { return share > 0.0 && share < 1.0; }
  /// Of the winding number, along the way.
  int change() const { return !within() ? 0 : leaves ? -1 : 1; }
};

/// A triangle as seen from a point. An edge that two triangles share, and run along opposite ways, gives both the same
/// numbers but for the sign: no way slips between, unless it hits the edge to the last bit.
class SeenTriangle {
 public:
  /// corners  relative to the point
  SeenTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : edges_{a.cross(b), b.cross(c), c.cross(a)}, volume_(a.dot(edges_[1])) {}

  Crossing crossing(const Eigen::Vector3d& way) const {
    const double x = way.dot(edges_[0]), y = way.dot(edges_[1]), z = way.dot(edges_[2]);
    const bool leaves = x > 0.0 && y > 0.0 && z > 0.0, enters = x < 0.0 && y < 0.0 && z < 0.0;
    if (!leaves && !enters) return {};
    return {volume_ / (x + y + z), leaves};
  }

 private:
  std::array<Eigen::Vector3d, 3> edges_;
  double volume_;
};

}  // namespace tetskin::cage_detail
