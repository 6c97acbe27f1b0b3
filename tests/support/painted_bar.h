// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A bar with a map painted on it: one value on half of it, another on the rest.
#pragma once

#include <tetskin/core/mesh.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "support/bars.h"

namespace tetskin::test {

/// The surface of a bar of 4 x 1 x 1 from the origin on, in squares with this many along a short side; even.
inline TriangleMesh barSurface(int across) {
  const TetMesh filled = makeBox({4 * across, across, across}, {4, 1, 1});
  TriangleMesh mesh;
  std::vector<int> number(filled.nodeCount(), -1);
  for (std::array<int, 3> face : boundaryFaces(filled)) {
    for (int& n : face) {
      int& vertex = number[static_cast<std::size_t>(n)];
      if (vertex < 0) {
        vertex = static_cast<int>(mesh.vertexCount());
        mesh.positions.push_back(filled.nodes[static_cast<std::size_t>(n)]);
      }
      n = vertex;
    }
    mesh.triangles.push_back(face);
  }
  return mesh;
}

/// 1 on the first half, `other` on the second one, and `between` on the vertices in the middle.
inline std::vector<double> halves(const TriangleMesh& bar, double other, double between) {
  std::vector<double> values;
  for (const Eigen::Vector3d& p : bar.positions) values.push_back(p.x() < 2.0 ? 1.0 : p.x() > 2.0 ? other : between);
  return values;
}

}  // namespace tetskin::test
