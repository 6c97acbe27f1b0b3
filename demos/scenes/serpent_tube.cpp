// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/serpent_tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

/// Indices of a tube's vertices: first pole, the rings, last pole.
struct TubeVertices {
  int first;
  TubeGrid grid;

  int operator()(int ring, int column) const {
    if (ring == 0) return first;
    return first + 1 + (ring - 1) * (grid.columns + 1) + (ring > grid.rings ? 0 : column);
  }
};

void appendVertices(TriangleMesh& mesh, const TubeGrid& grid, const TubeSurface& surface) {
  const auto append = [&](const Vector3d& position, float u, int ring) {
    mesh.positions.push_back(position);
    mesh.texcoords.emplace_back(u, static_cast<float>(ring) / static_cast<float>(grid.rings + 1));
  };
  append(surface(0, 0), 0.5f, 0);
  for (int ring = 1; ring <= grid.rings; ++ring) {
    const std::size_t seam = mesh.positions.size();
    for (int column = 0; column < grid.columns; ++column) {
      append(surface(ring, column), static_cast<float>(column) / static_cast<float>(grid.columns), ring);
    }
    append(Vector3d(mesh.positions[seam]), 1.0f, ring);
  }
  append(surface(grid.rings + 1, 0), 0.5f, grid.rings + 1);
}

void appendTriangles(TriangleMesh& mesh, const TubeVertices& vertex) {
  const int rings = vertex.grid.rings;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int column = 0; column < vertex.grid.columns; ++column) {
      const int a = vertex(ring, column), b = vertex(ring, column + 1);
      const int c = vertex(ring + 1, column), d = vertex(ring + 1, column + 1);
      // Diagonals alternate: if all had one direction, every relief would look brushed to one side.
      const bool rising = (ring + column) % 2 == 0;
      if (ring > 0) mesh.triangles.push_back({a, b, rising && ring < rings ? d : c});
      if (ring < rings) mesh.triangles.push_back({rising || ring == 0 ? a : b, d, c});
    }
  }
}

/// Area-weighted normals of the tube's vertices, the same on both sides of the seam.
void appendNormals(TriangleMesh& mesh, const TubeVertices& vertex, std::size_t firstTriangle) {
  std::vector<Vector3d> sums(mesh.positions.size() - vertex.first, Vector3d::Zero());
  for (std::size_t t = firstTriangle; t < mesh.triangles.size(); ++t) {
    const std::array<int, 3>& corners = mesh.triangles[t];
    const Vector3d& p = mesh.positions[corners[0]];
    const Vector3d area = (mesh.positions[corners[1]] - p).cross(mesh.positions[corners[2]] - p);
    for (int corner : corners) sums[corner - vertex.first] += area;
  }
  for (int ring = 1; ring <= vertex.grid.rings; ++ring) {
    Vector3d& left = sums[vertex(ring, 0) - vertex.first];
    Vector3d& right = sums[vertex(ring, vertex.grid.columns) - vertex.first];
    left = right = left + right;
  }
  for (const Vector3d& sum : sums) mesh.normals.push_back(sum.normalized().cast<float>());
}

}  // namespace

std::size_t TubeGrid::trianglesUpTo(int ring) const {
  const int bands = ring > rings ? 2 * rings : 2 * ring - 1;
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(columns);
}

TubeGrid tubeGrid(double triangles, double slenderness) {
  const double quads = triangles / 2.0;
  const int columns = std::max(3, static_cast<int>(std::lround(std::sqrt(quads / slenderness))));
  return {std::max(1, static_cast<int>(std::lround(quads / columns))), columns};
}

void appendTube(TriangleMesh& mesh, const TubeGrid& grid, const TubeSurface& surface) {
  assert(grid.rings >= 1 && grid.columns >= 3);
  const TubeVertices vertex{static_cast<int>(mesh.positions.size()), grid};
  const std::size_t firstTriangle = mesh.triangles.size();
  appendVertices(mesh, grid, surface);
  appendTriangles(mesh, vertex);
  appendNormals(mesh, vertex, firstTriangle);
}

}  // namespace tetskin::scenes
