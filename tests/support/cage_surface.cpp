// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/cage_surface.h"

#include "support/odd_meshes.h"

#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <limits>
#include <map>

namespace tetskin::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Cuts every triangle in four at the midpoints of its edges.
void cutInFour(TriangleMesh& mesh) {
  std::map<std::array<int, 2>, int> centroids;
  const auto centroid = [&](int a, int b) {
    const auto [entry, isNew] =
        centroids.insert({{std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.vertexCount())});
    if (isNew) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2.0);
    return entry->second;
  };
  std::vector<std::array<int, 3>> components;
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = centroid(a, b), bc = centroid(b, c), ca = centroid(c, a);
    components.insert(components.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(components);
}

Points vertexNormals(const TriangleMesh& mesh) {
  Points normals(mesh.vertexCount(), Eigen::Vector3d::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& p = mesh.positions[a];
    const Eigen::Vector3d area = (mesh.positions[b] - p).cross(mesh.positions[c] - p);
    for (const int v : {a, b, c}) normals[v] += area;
  }
  for (Eigen::Vector3d& n : normals) n.normalize();
  return normals;
}

}  // namespace

TriangleMesh surfaceBeside(const TetMesh& cage, double distance, int cuts) {
  TriangleMesh mesh;
  std::map<int, int> vertexOf;
  for (std::array<int, 3> face : boundaryFaces(cage)) {
    for (int& n : face) {
      const auto [entry, isNew] = vertexOf.insert({n, static_cast<int>(mesh.vertexCount())});
      if (isNew) mesh.positions.push_back(cage.nodes[n]);
      n = entry->second;
    }
    mesh.triangles.push_back(face);
  }
  for (int k = 0; k < cuts; ++k) cutInFour(mesh);
  const Points normals = vertexNormals(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.positions[v] += distance * normals[v];
  return mesh;
}

BoundaryFollower::BoundaryFollower(const TetMesh& cage, const Points& vertices) {
  const auto faces = boundaryFaces(cage);
  for (const Eigen::Vector3d& v : vertices) {
    Position position{};
    double squared = std::numeric_limits<double>::infinity();
    for (const auto& face : faces) {
      const Eigen::Vector3d &a = cage.nodes[face[0]], &b = cage.nodes[face[1]], &c = cage.nodes[face[2]];
      const Eigen::Vector3d q = closestPointOnTriangle(v, a, b, c).point;
      if ((v - q).squaredNorm() >= squared) continue;
      squared = (v - q).squaredNorm();
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      const double scale = 1.0 / normal.squaredNorm();
      const double wb = (q - a).cross(c - a).dot(normal) * scale, wc = (b - a).cross(q - a).dot(normal) * scale;
      position = {face, {1.0 - wb - wc, wb, wc}, v - q};
    }
    positions_.push_back(position);
  }
}

Points BoundaryFollower::positions(const Points& nodes) const {
  Points result;
  for (const Position& p : positions_) {
    result.push_back(p.offset + p.weights[0] * nodes[p.face[0]] + p.weights[1] * nodes[p.face[1]] +
                     p.weights[2] * nodes[p.face[2]]);
  }
  return result;
}

Points movedAtRandom(Points points, double length, unsigned seed) {
  const Points directions =
      randomPoints(points.size(), {Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0)}, seed);
  for (std::size_t k = 0; k < points.size(); ++k) points[k] += length * directions[k].normalized();
  return points;
}

}  // namespace tetskin::test
