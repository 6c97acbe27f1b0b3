// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/body_model.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "scenes/caged_mesh.h"
#include "scenes/solid_meshes.h"

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
  // Data about single vertices does not hold for the copies; a convex body has no duplicate tets.
  cage.vertexTets.clear();
  cage.meshHash.reset();
  return makeModel(std::move(mesh), std::move(cage));
}

ModelPtr makeBall(std::size_t tets, int level, Copies copies) {
  TriangleMesh mesh = scenes::icosphere(level);
  const Eigen::AngleAxisd turn(0.3, Vector3d(1, 2, 3).normalized());
  for (Vector3d& p : mesh.positions) p = turn * (0.5 * p);
  return inBuiltCage(std::move(mesh), tets, copies);
}

ModelPtr makeBox(const Vector3d& halfExtents, int divisions, Copies copies) {
  return inBuiltCage(scenes::boxOfGrids(halfExtents, divisions), 1000, copies);
}

ModelPtr makeWavyBox(const Vector3d& halfExtents, int divisions, double wave) {
  TriangleMesh mesh = scenes::boxOfGrids(halfExtents, divisions);
  const double turn = 0.5 * EIGEN_PI * divisions / (2.0 * halfExtents.maxCoeff());
  const double top = boundingBox(mesh.positions).max().y();
  for (Vector3d& p : mesh.positions) {
    if (p.y() == top) p.y() += 0.5 * wave * (std::cos(turn * p.x()) * std::cos(turn * p.z()) - 1.0);
  }
  return inBuiltCage(std::move(mesh), 1000, {});
}

ModelPtr makeCoarseBox(const Vector3d& halfExtents, std::size_t tets) {
  TriangleMesh mesh = scenes::gridBox(Vector3i::Ones());
  for (Vector3d& p : mesh.positions) p = 2.0 * halfExtents.cwiseProduct(p - Vector3d::Constant(0.5));
  return inBuiltCage(std::move(mesh), tets, {});
}

ModelPtr makeLattice(const Vector3i& cubes, double edge) {
  constexpr int kFiner = 4;
  TriangleMesh mesh = scenes::gridBox(kFiner * cubes);
  for (Vector3d& p : mesh.positions) p = edge * (p / kFiner - 0.5 * cubes.cast<double>());
  return makeModel(std::move(mesh), latticeTets(cubes, edge));
}

}  // namespace tetskin::measure
