// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/bvh/bvh.h>
#include <tetskin/core/src/base/mesh/triangle_geometry.h>

#include <limits>
#include <vector>

namespace tetskin {

/// The point of a surface nearest to another.
struct NearestPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int triangle = -1;  ///< of the mesh; -1: none is near enough
  double squaredDistance = std::numeric_limits<double>::infinity();
  int index = -1;  ///< of the triangle in the hierarchy
};

/// Computes distances of points from triangles at rest.
class TETSKIN_CORE_API TriangleBvh {
 public:
  /// mesh  indices in range, coordinates finite. Not kept. Cost O(n log n) for n triangles
  explicit TriangleBvh(const TriangleMesh& mesh);
  /// Only for some of the triangles.
  TriangleBvh(const TriangleMesh& mesh, const std::vector<int>& triangles);

  /// The nearest point. If several triangles are at the same distance, the choice is always the same one.
  /// squaredBound  only nearer points are searched for: the smaller, the faster
  NearestPoint nearest(const Eigen::Vector3d& p, double squaredBound = std::numeric_limits<double>::infinity()) const;
  /// The nearest point, with a guess; if several triangles are at the same distance, the choice may depend on the
  /// guess.
  /// guess  the result, if any, for a point nearby: the nearer, the faster
  NearestPoint nearest(const Eigen::Vector3d& p, const NearestPoint& guess) const;

 private:
  void test(int index, const Eigen::Vector3d& p, NearestPoint& best) const;
  void search(const Eigen::Vector3d& p, NearestPoint& best) const;

  Bvh bvh_;
  std::vector<BvhBox<double>> boxes_;       ///< by node
  std::vector<TriangleCorners> triangles_;  ///< in the order of the leaves
};

}  // namespace tetskin
