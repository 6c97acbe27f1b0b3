// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ContactShape: how far a point is from a surface at rest.
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <array>
#include <limits>
#include <vector>

namespace tetskin::contact_detail {

/// The point of a surface nearest to another.
struct NearestPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int triangle = -1;  ///< of the mesh; -1: none is near enough
  double squaredDistance = std::numeric_limits<double>::infinity();
};

/// A tree of a mesh's triangles.
class TriangleTree {
 public:
  /// mesh  indices in range, coordinates finite. May go away afterwards. Cost O(n log n) for n triangles
  explicit TriangleTree(const TriangleMesh& mesh);

  /// The same, of some of the triangles.
  TriangleTree(const TriangleMesh& mesh, const std::vector<int>& triangles);

  /// squaredBound  nothing at this distance or beyond is wanted: the smaller, the faster
  NearestPoint nearest(const Eigen::Vector3d& p, double squaredBound = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Box3 box;
    int first = 0, last = 0;
    int right = 0;  ///< second child, 0 in a leaf; the first child is the next node
  };
  using Corners = std::array<Eigen::Vector3d, 3>;

  void build(const TriangleMesh& mesh, int first, int last);
  void fillLeaf(const TriangleMesh& mesh, Node& node);
  void search(int index, const Eigen::Vector3d& p, NearestPoint& best) const;

  std::vector<Node> nodes_;
  std::vector<int> order_;          ///< triangles as the leaves have them
  std::vector<Corners> triangles_;  ///< in that order
};

}  // namespace tetskin::contact_detail
