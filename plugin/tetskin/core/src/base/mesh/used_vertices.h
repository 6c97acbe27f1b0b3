// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Vertices of parts that a modeller has cut off often stay in the file. They are not drawn, so no size and no contact
// may depend on them.
#pragma once

#include <tetskin/core/mesh.h>

#include <vector>

namespace tetskin {

/// By vertex: whether a triangle uses it. A mesh without triangles is a point cloud, in which all count.
inline std::vector<char> usedVertices(const TriangleMesh& mesh) {
  std::vector<char> used(mesh.vertexCount(), mesh.triangles.empty() ? 1 : 0);
  for (const std::array<int, 3>& t : mesh.triangles) {
    for (const int v : t) used[static_cast<std::size_t>(v)] = 1;
  }
  return used;
}

/// Box of the used vertices.
inline Box3 surfaceBox(const TriangleMesh& mesh) {
  const std::vector<char> used = usedVertices(mesh);
  Box3 box;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) box.extend(mesh.positions[v]);
  }
  return box;
}

}  // namespace tetskin
