// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace tetskin::test {

/// The triangles of a sphere of radius 1, outwards: an octahedron's, each divided into four `level` times.
inline TriangleMesh sphereOf(int level) {
  TriangleMesh sphere;
  sphere.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  sphere.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < level; ++k) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, isNew] = middles.insert({std::minmax(a, b), static_cast<int>(sphere.positions.size())});
      if (isNew) sphere.positions.push_back((sphere.positions[a] + sphere.positions[b]).normalized());
      return found->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : sphere.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const std::array<int, 3>& t : {std::array<int, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
        finer.push_back(t);
      }
    }
    sphere.triangles = std::move(finer);
  }
  return sphere;
}

/// A hollow sphere of tets between two radii, about the origin.
inline TetMesh hollowSphere(double inner, double outer, int level, int layers) {
  const TriangleMesh sphere = sphereOf(level);
  const int count = static_cast<int>(sphere.vertexCount());
  TetMesh cage;
  for (int layer = 0; layer <= layers; ++layer) {
    const double radius = inner + (outer - inner) * layer / layers;
    for (const Eigen::Vector3d& x : sphere.positions) cage.nodes.push_back(radius * x);
  }
  for (int layer = 0; layer < layers; ++layer) {
    for (std::array<int, 3> t : sphere.triangles) {
      std::sort(t.begin(), t.end());
      std::array<int, 6> n{};
      for (std::size_t k = 0; k < 3; ++k) {
        n[k] = t[k] + layer * count;
        n[k + 3] = n[k] + count;
      }
      for (const Tet& tet : {Tet{n[0], n[1], n[2], n[5]}, Tet{n[0], n[1], n[4], n[5]}, Tet{n[0], n[3], n[4], n[5]}}) {
        cage.tets.push_back(tet);
      }
    }
  }
  (void)repairTetMesh(cage);
  return cage;
}

}  // namespace tetskin::test
