// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ContactShape: the signed distance from a surface at rest, on a grid.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/core/src/base/mesh/triangle_bvh.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <array>
#include <vector>

namespace tetskin::contact_detail {

/// A gradient shorter than this has no direction, as in the middle of a thin part.
constexpr btScalar kNoDirection = btScalar(0.1);
/// A gradient at the surface at least this long is not on an edge.
constexpr btScalar kOnFace = btScalar(0.9);

/// The result of the grid at a point.
struct GridDistance {
  btScalar distance = 0;  ///< below 0 inside
  btVector3 gradient{0, 0, 0};
};

/// The number of corners of a grid.
/// cells  as for its constructor
double cornersOfGrid(const Box3& box, int cells);

/// Signed distances at the corners of cubes, interpolated trilinearly between them; the gradient is that of the
/// interpolation.
class DistanceGrid {
 public:
  DistanceGrid() = default;
  /// outside  the triangles that bound the union of all components; distances are measured from them
  /// solid    all triangles, which determine what is inside
  /// box      to be covered; a border of a few cubes is added
  /// cells    number of cubes along its longest side, at least 1
  /// Cost     some microseconds per corner
  DistanceGrid(const TriangleBvh& outside, const WindingTree& solid, const Box3& box, int cells);

  /// Returns false, and writes nothing, for a point outside of the grid.
  bool at(const btVector3& point, GridDistance& result) const;
  /// Side of a cube.
  btScalar spacing() const { return spacing_; }
  /// The largest change of the distance per length.
  btScalar steepness() const { return steepness_; }
  /// True if any corner is inside.
  bool hasInside() const;

 private:
  std::size_t indexOf(int x, int y, int z) const {
    return static_cast<std::size_t>(x) + stride_[1] * static_cast<std::size_t>(y) +
           stride_[2] * static_cast<std::size_t>(z);
  }
  void fillRow(const TriangleBvh& outside, const WindingTree& solid, const Eigen::Vector3d& first, double spacing,
               float* row) const;
  void findSteepness();

  btVector3 low_{0, 0, 0};
  btScalar spacing_ = 1, inverseSpacing_ = 1, steepness_ = 1;
  std::array<int, 3> counts_{};          ///< number of corners along each axis
  std::array<std::size_t, 3> stride_{};  ///< distance in the array between neighbouring corners, by axis
  std::vector<float> distances_;
};

}  // namespace tetskin::contact_detail
