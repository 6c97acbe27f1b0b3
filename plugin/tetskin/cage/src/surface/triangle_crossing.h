// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace tetskin::cage_detail {

/// Where a straight segment crosses a triangle.
struct Crossing {
  double fraction = std::numeric_limits<double>::quiet_NaN();  ///< fraction of the segment; NaN if it does not cross
  bool leaves = false;                                         ///< it crosses in the direction of the triangle's normal

  bool within() const { return fraction > 0.0 && fraction < 1.0; }
  /// The change of the winding number along the segment.
  int change() const { return !within() ? 0 : leaves ? -1 : 1; }
};

/// A triangle as seen from a point. An edge of two triangles that use it in opposite directions gives both the same
/// numbers except for the sign: no segment passes between them, unless it hits the edge to the last bit.
class SeenTriangle {
 public:
  /// a, b, c  its corners, relative to the point
  SeenTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : edges_{a.cross(b), b.cross(c), c.cross(a)}, volume_(a.dot(edges_[1])) {}

  Crossing crossing(const Eigen::Vector3d& direction) const {
    const double x = direction.dot(edges_[0]), y = direction.dot(edges_[1]), z = direction.dot(edges_[2]);
    const bool leaves = x > 0.0 && y > 0.0 && z > 0.0, enters = x < 0.0 && y < 0.0 && z < 0.0;
    if (!leaves && !enters) return {};
    return {volume_ / (x + y + z), leaves};
  }

 private:
  std::array<Eigen::Vector3d, 3> edges_;
  double volume_;
};

}  // namespace tetskin::cage_detail
