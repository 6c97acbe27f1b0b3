// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/body_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "scenes/caged_mesh.h"

namespace tetskin::measure {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

double volumeOf(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
  }
  return volume;
}

/// Vertices that no triangle uses are contact samples like all others.
void appendCopies(TriangleMesh& mesh, Copies copies) {
  constexpr double kApart = 1e-6;
  const std::vector<Vector3d> once = mesh.positions;
  const double size = boundingBox(once).sizes().maxCoeff();
  std::mt19937 random(1);
  const auto offset = [&] { return kApart * size * (static_cast<double>(random()) / std::mt19937::max() - 0.5); };
  for (int copy = 1; copy < copies.count; ++copy) {
    for (const Vector3d& p : once) mesh.positions.push_back(p + Vector3d(offset(), offset(), offset()));
  }
}

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

/// The surface of a box of unit cubes with a corner at the origin, and a grid of these as its vertices.
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

/// The surface of a box about the origin.
/// divisions  of its longest edge
TriangleMesh boxOfGrids(const Vector3d& halfExtents, int divisions) {
  const double edge = 2.0 * halfExtents.maxCoeff() / divisions;
  const Vector3i cubes = (2.0 / edge * halfExtents).array().round().cast<int>();
  TriangleMesh mesh = gridBox(cubes);
  for (Vector3d& p : mesh.positions) p = edge * p - halfExtents;
  return mesh;
}

TetMesh latticeTets(const Vector3i& cubes, double edge) {
  static const std::array<std::array<int, 3>, 6> kPaths = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  TetMesh lattice;
  const auto node = [&](const Vector3i& at) { return at.x() + (cubes.x() + 1) * (at.y() + (cubes.y() + 1) * at.z()); };
  const Vector3d centre = 0.5 * cubes.cast<double>();
  for (int z = 0; z <= cubes.z(); ++z) {
    for (int y = 0; y <= cubes.y(); ++y) {
      for (int x = 0; x <= cubes.x(); ++x) lattice.nodes.emplace_back(edge * (Vector3d(x, y, z) - centre));
    }
  }
  for (int z = 0; z < cubes.z(); ++z) {
    for (int y = 0; y < cubes.y(); ++y) {
      for (int x = 0; x < cubes.x(); ++x) {
        for (const auto& path : kPaths) {
          Vector3i at(x, y, z);
          Tet tet{node(at)};
          for (std::size_t k = 0; k < 3; ++k) {
            ++at[path[k]];
            tet[k + 1] = node(at);
          }
          lattice.tets.push_back(tet);
        }
      }
    }
  }
  (void)repairTetMesh(lattice);  // half of the paths make negative tets
  return lattice;
}

}  // namespace

ModelPtr makeModel(TriangleMesh mesh, Cage cage) {
  auto model = std::make_shared<BodyModel>();
  model->size = boundingBox(mesh.positions).sizes().maxCoeff();
  model->volume = volumeOf(mesh);
  model->binding = scenes::boundTo(cage, mesh);
  model->mesh = std::move(mesh);
  model->cage = std::move(cage);
  return model;
}

ModelPtr inBuiltCage(TriangleMesh mesh, std::size_t tets, Copies copies) {
  Cage cage = scenes::builtCage(mesh, tets);
  if (copies.count == 1) return makeModel(std::move(mesh), std::move(cage));
  appendCopies(mesh, copies);
  // What is known of single vertices does not hold for the copies; a convex body has no duplicate tets.
  cage.vertexTets.clear();
  cage.meshHash.reset();
  return makeModel(std::move(mesh), std::move(cage));
}

ModelPtr makeBall(std::size_t tets, int level, Copies copies) {
  TriangleMesh mesh = icosahedron();
  for (Vector3d& p : mesh.positions) p.normalize();
  for (int k = 0; k < level; ++k) {
    mesh = refined(mesh);
    for (Vector3d& p : mesh.positions) p.normalize();
  }
  const Eigen::AngleAxisd turn(0.3, Vector3d(1, 2, 3).normalized());
  for (Vector3d& p : mesh.positions) p = turn * (0.5 * p);
  return inBuiltCage(std::move(mesh), tets, copies);
}

ModelPtr makeBox(const Vector3d& halfExtents, int divisions, Copies copies) {
  return inBuiltCage(boxOfGrids(halfExtents, divisions), 1000, copies);
}

ModelPtr makeWavyBox(const Vector3d& halfExtents, int divisions, double wave) {
  TriangleMesh mesh = boxOfGrids(halfExtents, divisions);
  const double turn = 0.5 * EIGEN_PI * divisions / (2.0 * halfExtents.maxCoeff());
  const double top = boundingBox(mesh.positions).max().y();
  for (Vector3d& p : mesh.positions) {
    if (p.y() == top) p.y() += 0.5 * wave * (std::cos(turn * p.x()) * std::cos(turn * p.z()) - 1.0);
  }
  return inBuiltCage(std::move(mesh), 1000, {});
}

ModelPtr makeCoarseBox(const Vector3d& halfExtents, std::size_t tets) {
  TriangleMesh mesh = gridBox(Vector3i::Ones());
  for (Vector3d& p : mesh.positions) p = 2.0 * halfExtents.cwiseProduct(p - Vector3d::Constant(0.5));
  return inBuiltCage(std::move(mesh), tets, {});
}

ModelPtr makeLattice(const Vector3i& cubes, double edge) {
  constexpr int kFiner = 4;
  TriangleMesh mesh = gridBox(kFiner * cubes);
  for (Vector3d& p : mesh.positions) p = edge * (p / kFiner - 0.5 * cubes.cast<double>());
  return makeModel(std::move(mesh), latticeTets(cubes, edge));
}

}  // namespace tetskin::measure
