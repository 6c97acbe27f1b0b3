// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How deep bodies penetrate each other as drawn, independent of the contact that keeps them apart: every vertex of each
// body is tested against all triangles of the others.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>
#include <vector>

namespace tetskin::scenes {

struct DeepestVertex {
  double depth = 0.0;     ///< distance to the nearest triangle of the other body; 0: no vertex is in another body
  std::size_t body = 0;   ///< the body that the vertex belongs to
  int vertex = -1;        ///< index in that body's mesh; -1: none
  std::size_t other = 0;  ///< the body that contains the vertex
  std::size_t count = 0;  ///< number of vertices that lie in other bodies
};

/// A vertex is inside a body where the generalised winding number of its triangles is above a half; see WindingTree.
/// surfaces  closed, their triangles facing outwards, coordinates finite. Costs O(n log n) for n vertices and triangles
DeepestVertex deepestVertex(const std::vector<TriangleMesh>& surfaces);

}  // namespace tetskin::scenes
