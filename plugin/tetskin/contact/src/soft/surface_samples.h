// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ContactShape: points distributed over a surface.
#pragma once

#include <tetskin/core/mesh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin::contact_detail {

/// A point of a mesh at rest: a vertex, or a point on a triangle.
struct SurfaceSample {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int vertex = -1;                         ///< -1: none
  std::array<int, 3> corners{-1, -1, -1};  ///< vertices of a triangle that it is on
};

/// About `count` points of these triangles, evenly distributed: vertices if there are enough; among neighbouring
/// vertices, those that protrude most.
/// mesh   indices in range
/// Cost   O(n log n + count) for n triangles
std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, const std::vector<int>& triangles,
                                         std::size_t count);

}  // namespace tetskin::contact_detail
