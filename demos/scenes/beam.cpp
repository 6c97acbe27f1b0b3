// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/beam.h"

#include <algorithm>
#include <cmath>

#include "scenes/serpent.h"
#include "scenes/solid_meshes.h"

namespace tetskin::scenes {
namespace {

const Eigen::Vector3d kHalf(2.0, 0.5, 0.5);

}  // namespace

TriangleMesh makeBeam(std::size_t triangles) {
  // Four sides of 4 n^2 squares and two ends of n^2, each of two triangles.
  constexpr double kTrianglesOfSquare = 36.0;
  const std::size_t wish = std::clamp(triangles, kMinSerpentTriangles, kMaxSerpentTriangles);
  const int across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(wish) / kTrianglesOfSquare)));
  TriangleMesh mesh = boxOfGrids(kHalf, 4 * across);
  mesh.groups.push_back({"beam", "beam", 0, mesh.triangleCount()});
  return mesh;
}

TetMesh makeBeamTets(std::size_t tets) {
  constexpr double kCoarsest = 20.0;  // five tets in each of four cells
  const int across = std::max(1, static_cast<int>(std::lround(std::cbrt(static_cast<double>(tets) / kCoarsest))));
  const Eigen::Vector3i size(4 * across, across, across);
  TetMesh mesh;
  const auto node = [&](const Eigen::Vector3i& c) { return (c.z() * (across + 1) + c.y()) * (size.x() + 1) + c.x(); };
  for (int z = 0; z <= across; ++z) {
    for (int y = 0; y <= across; ++y) {
      for (int x = 0; x <= size.x(); ++x) {
        const Eigen::Array3d share = Eigen::Array3d(x, y, z) / size.array().cast<double>();
        mesh.nodes.emplace_back(kHalf.array() * (2.0 * share - 1.0));
        if (x == size.x() || y == across || z == across) continue;
        // Corners as bits; mirrored in every other cell, so that faces have the same diagonal on both sides.
        const bool odd = (x + y + z) % 2 != 0;
        const auto at = [&](int bits) {
          return node({x + static_cast<int>(((bits & 1) != 0) != odd), y + ((bits >> 1) & 1), z + ((bits >> 2) & 1)});
        };
        for (const Tet& tet : {Tet{0, 3, 5, 6}, Tet{1, 0, 3, 5}, Tet{2, 0, 3, 6}, Tet{4, 0, 5, 6}, Tet{7, 3, 5, 6}}) {
          mesh.tets.push_back({at(tet[0]), at(tet[1]), at(tet[2]), at(tet[3])});
        }
      }
    }
  }
  (void)repairTetMesh(mesh);
  return mesh;
}

}  // namespace tetskin::scenes
