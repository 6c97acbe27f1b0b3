// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/driven_nodes.h"

#include "report/cage_skin.h"
#include "scenes/input_error.h"
#include "scenes/tets_of_nodes.h"

namespace tetskin::report {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

Eigen::Vector4d weightsIn(const TetMesh& cage, const Tet& tet, const Eigen::Vector3d& point) {
  Eigen::Matrix4d corners;
  for (int k = 0; k < 4; ++k) corners.col(k) << cage.nodes[tet[k]], 1.0;
  return corners.inverse() * point.homogeneous();
}

}  // namespace

DrivenNodes::DrivenNodes(const TriangleMesh& mesh, const Cage& driver, const Cage& cage) : driver_(driver) {
  placeNodes(mesh, cage);
  bindCentroids();
}

void DrivenNodes::placeNodes(const TriangleMesh& mesh, const Cage& cage) {
  const std::vector<int> tets = scenes::tetsOfNodes(mesh, driver_, cage);
  for (std::size_t n = 0; n < tets.size(); ++n) {
    Position& position = positions_.emplace_back();
    position.tet = tets[n];
    position.weights = weightsIn(driver_.mesh, driver_.mesh.tets[position.tet], cage.mesh.nodes[n]);
    position.nearest = position.weights.cwiseMax(0.0);
    position.nearest /= position.nearest.sum();
  }
}

void DrivenNodes::bindCentroids() {
  TriangleMesh points;
  Cage mapped = static_cast<const TetMesh&>(driver_.mesh);
  for (const Position& position : positions_) {
    const Tet& tet = driver_.mesh.tets[position.tet];
    for (const auto& [i, j] : kEdges) {
      points.positions.push_back(0.5 * (driver_.mesh.nodes[tet[i]] + driver_.mesh.nodes[tet[j]]));
      mapped.vertexTets.push_back(position.tet);
    }
  }
  BindingOptions options;
  options.interpolation = Interpolation::Quadratic;
  centroids_ = skinOf(mapped, points, options);
}

std::vector<Eigen::Vector3f> DrivenNodes::positionsAt(const std::vector<Eigen::Vector3d>& driverNodes) {
  if (centroids_.update(viewOf(driverNodes)) != StatusCode::Ok) {
    throw scenes::InputError("the reference has node positions that are not finite");
  }
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(positions_.size());
  for (std::size_t n = 0; n < positions_.size(); ++n) positions.push_back(positionOf(n, driverNodes).cast<float>());
  return positions;
}

Eigen::Vector3d DrivenNodes::positionOf(std::size_t node, const std::vector<Eigen::Vector3d>& driverNodes) const {
  const auto& [tetIndex, b, q] = positions_[node];
  const Tet& tet = driver_.mesh.tets[tetIndex];
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int k = 0; k < 4; ++k) position += b[k] * driverNodes[tet[k]];
  for (std::size_t e = 0; e < kEdges.size(); ++e) {
    const auto [i, j] = kEdges[e];
    const Eigen::Map<const Eigen::Vector3d> centroid(centroids_.positions()[kEdges.size() * node + e]);
    const Eigen::Vector3d bulge = 4.0 * centroid - 2.0 * (driverNodes[tet[i]] + driverNodes[tet[j]]);
    position += (q[i] * b[j] + b[i] * q[j] - q[i] * q[j]) * bulge;
  }
  return position;
}

}  // namespace tetskin::report
