// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/bvh/bvh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin {

/// Winding number above which a point is inside; of either sign if surfaces may be inverted.
constexpr double kInside = 0.5;

/// Generalised winding number of triangles: 1 inside a closed surface, 0 outside, and in between,
/// smoothly, near holes. Far groups of triangles count as one dipole, which costs an error of up to 0.03.
class TETSKIN_CORE_API WindingTree {
 public:
  using Triangles = std::vector<std::array<int, 3>>;

  /// Uses the first `count` triangles; all must have area. They may be destroyed afterwards. Cost O(n log n)
  WindingTree(const std::vector<Eigen::Vector3d>& points, const Triangles& triangles, std::size_t count);
  /// Uses those triangles of a mesh that have area.
  explicit WindingTree(const TriangleMesh& mesh);

  /// Cost about O(log n). 0 if there are no triangles.
  double windingNumber(const Eigen::Vector3d& p) const;

 private:
  /// Far-field approximation of a node's triangles.
  struct Dipole {
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< area-weighted
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();    ///< sum of the area vectors
    double area = 0.0;
    double radius = 0.0;  ///< radius of a ball about the centroid that contains all corners
  };
  using Corners = std::array<Eigen::Vector3d, 3>;

  Dipole ofLeaf(const Bvh::Node& leaf) const;
  static Dipole ofChildren(const Dipole& a, const Dipole& b);
  double walk(int node, const Eigen::Vector3d& p) const;

  Bvh bvh_;
  std::vector<Corners> triangles_;  ///< in the order of the leaves
  std::vector<Dipole> dipoles_;     ///< by node
};

}  // namespace tetskin
