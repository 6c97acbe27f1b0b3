// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/solid_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

TriangleMesh icosahedron() {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

TriangleMesh refined(const TriangleMesh& coarse) {
  TriangleMesh fine;
  fine.positions = coarse.positions;
  std::map<std::pair<int, int>, int> midpoints;
  const auto midpoint = [&](int a, int b) {
    const auto [found, isNew] = midpoints.try_emplace(std::minmax(a, b), static_cast<int>(fine.positions.size()));
    if (isNew) fine.positions.emplace_back(0.5 * (coarse.positions[a] + coarse.positions[b]));
    return found->second;
  };
  for (const auto& t : coarse.triangles) {
    const int a = midpoint(t[0], t[1]), b = midpoint(t[1], t[2]), c = midpoint(t[2], t[0]);
    for (const auto& child : {std::array<int, 3>{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}}) {
      fine.triangles.push_back(child);
    }
  }
  return fine;
}

}  // namespace

TriangleMesh gridBox(const Vector3i& cubes) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> vertices;
  const auto vertex = [&](const Vector3i& at) {
    const auto [found, isNew] = vertices.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(mesh.positions.size()));
    if (isNew) mesh.positions.emplace_back(at.cast<double>());
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
    for (const bool far : {false, true}) {
      for (int i = 0; i < cubes[(axis + 1) % 3]; ++i) {
        for (int k = 0; k < cubes[(axis + 2) % 3]; ++k) {
          const Vector3i at = (far ? cubes[axis] : 0) * Vector3i::Unit(axis) + i * u + k * v;
          const int a = vertex(at), b = vertex(at + u), c = vertex(at + u + v), d = vertex(at + v);
          far ? mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}})
              : mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
        }
      }
    }
  }
  return mesh;
}

TriangleMesh boxOfGrids(const Vector3d& halfExtents, int divisions) {
  const double edge = 2.0 * halfExtents.maxCoeff() / divisions;
  const Vector3i cubes = (2.0 / edge * halfExtents).array().round().cast<int>();
  TriangleMesh mesh = gridBox(cubes);
  for (Vector3d& p : mesh.positions) p = edge * p - halfExtents;
  return mesh;
}

TriangleMesh icosphere(int level) {
  TriangleMesh mesh = icosahedron();
  for (Vector3d& p : mesh.positions) p.normalize();
  for (int k = 0; k < level; ++k) {
    mesh = refined(mesh);
    for (Vector3d& p : mesh.positions) p.normalize();
  }
  return mesh;
}

}  // namespace tetskin::scenes
