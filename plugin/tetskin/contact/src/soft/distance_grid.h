// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ContactShape: the signed distance from a surface at rest, on a grid.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/core/src/shared/mesh/triangle_bvh.h>
#include <tetskin/core/src/shared/mesh/winding_tree.h>

#include <array>
#include <vector>

namespace tetskin::contact_detail {

/// What the grid tells at a point.
/// Length of a gradient below which it has no direction: on the middle of a thin part.
constexpr btScalar kNoDirection = btScalar(0.1);

struct GridDistance {
  btScalar distance = 0;  ///< below 0 inside
  btVector3 gradient{0, 0, 0};
};

/// Distances at the corners of cubes; between them trilinear, with the gradient of that.
class DistanceGrid {
 public:
  DistanceGrid() = default;
  /// outside  the triangles that are not within the solid that they bound with others; distances are from them
  /// solid    all triangles: what is inside
  /// box      to be covered, a few cubes around it too
  /// cells    along its longest side, at least 1
  /// Cost     some microseconds a corner
  DistanceGrid(const TriangleBvh& outside, const WindingTree& solid, const Box3& box, int cells);

  /// False, and nothing written, beyond the grid.
  bool at(const btVector3& point, GridDistance& result) const;
  /// Side of a cube.
  btScalar spacing() const { return spacing_; }
  /// Whether any corner is inside.
  bool hasInside() const;

 private:
  std::size_t indexOf(int x, int y, int z) const {
    return static_cast<std::size_t>(x) + stride_[1] * static_cast<std::size_t>(y) +
           stride_[2] * static_cast<std::size_t>(z);
  }
  void fillRow(const TriangleBvh& outside, const WindingTree& solid, const Eigen::Vector3d& first, double spacing,
               float* row) const;

  btVector3 low_{0, 0, 0};
  btScalar spacing_ = 1, inverseSpacing_ = 1;
  std::array<int, 3> counts_{};          ///< of corners
  std::array<std::size_t, 3> stride_{};  ///< of corners
  std::vector<float> distances_;
};

}  // namespace tetskin::contact_detail
