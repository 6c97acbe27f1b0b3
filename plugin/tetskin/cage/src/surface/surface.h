// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The mesh in the form that the later stages need: welded, without repeated triangles, consistently oriented where
// possible.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// A surface whose volume is below this fraction of its area to the power of 3/2 (0.094 for a sphere) is a sheet
/// without an inside; the rest is rounding error.
constexpr double kSheetVolume = 1e-6;

struct Surface {
  std::vector<Eigen::Vector3d> points;        ///< distinct positions that triangles use, rest space
  std::vector<int> pointOf;                   ///< by vertex of the mesh: its point; -1 if no triangle uses its position
  std::vector<std::array<int, 3>> triangles;  ///< distinct ones; the first `solidCount` of them have area
  std::size_t solidCount = 0;
  std::size_t looseVertices = 0;  ///< vertices without a point
  Box3 box;                       ///< box of all points

  std::size_t components = 0;  ///< number of sets of triangles connected by points
  std::size_t openEdges = 0;   ///< number of edges without a partner triangle that uses them in the opposite direction
  bool oriented = false;       ///< most edges have such partners, so winding numbers are reliable
  double area = 0.0;
  double volume = 0.0;  ///< enclosed volume, by the divergence theorem about the box's centre; 0 for a sheet
};

/// Welds coincident vertices; drops repeated triangles (double-sided faces are one face), triangles whose corners are
/// at one position, and vertices that no triangle uses; makes the orientation of neighbours consistent; and measures.
/// The mesh must have passed `validate`. Cost O(n log n) at worst, in practice linear in vertices and triangles.
Surface prepareSurface(const TriangleMesh& mesh);

inline WindingTree windingTreeOf(const Surface& surface) {
  return {surface.points, surface.triangles, surface.solidCount};
}

/// Area-weighted normal of a triangle: half the cross product of two edges.
inline Eigen::Vector3d areaVector(const Surface& surface, const std::array<int, 3>& t) {
  const Eigen::Vector3d& a = surface.points[t[0]];
  return 0.5 * (surface.points[t[1]] - a).cross(surface.points[t[2]] - a);
}

}  // namespace tetskin::cage_detail
