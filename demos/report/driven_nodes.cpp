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
  bindMiddles();
}

void DrivenNodes::placeNodes(const TriangleMesh& mesh, const Cage& cage) {
  const std::vector<int> tets = scenes::tetsOfNodes(mesh, driver_, cage);
  for (std::size_t n = 0; n < tets.size(); ++n) {
    Place& place = places_.emplace_back();
    place.tet = tets[n];
    place.weights = weightsIn(driver_, driver_.tets[place.tet], cage.nodes[n]);
    place.nearest = place.weights.cwiseMax(0.0);
    place.nearest /= place.nearest.sum();
  }
}

void DrivenNodes::bindMiddles() {
  TriangleMesh points;
  Cage mapped = static_cast<const TetMesh&>(driver_);
  for (const Place& place : places_) {
    const Tet& tet = driver_.tets[place.tet];
    for (const auto& [i, j] : kEdges) {
      points.positions.push_back(0.5 * (driver_.nodes[tet[i]] + driver_.nodes[tet[j]]));
      mapped.vertexTets.push_back(place.tet);
    }
  }
  BindingOptions options;
  options.interpolation = Interpolation::Quadratic;
  middles_ = skinOf(mapped, points, options);
}

std::vector<Eigen::Vector3f> DrivenNodes::positionsAt(const std::vector<Eigen::Vector3d>& driverNodes) {
  if (middles_.update(viewOf(driverNodes)) != UpdateStatus::Updated) {
    throw scenes::InputError("the reference is not finite");
  }
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(places_.size());
  for (std::size_t n = 0; n < places_.size(); ++n) positions.push_back(positionOf(n, driverNodes).cast<float>());
  return positions;
}

Eigen::Vector3d DrivenNodes::positionOf(std::size_t node, const std::vector<Eigen::Vector3d>& driverNodes) const {
  const auto& [tetIndex, b, q] = places_[node];
  const Tet& tet = driver_.tets[tetIndex];
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int k = 0; k < 4; ++k) position += b[k] * driverNodes[tet[k]];
  for (std::size_t e = 0; e < kEdges.size(); ++e) {
    const auto [i, j] = kEdges[e];
    const Eigen::Map<const Eigen::Vector3d> middle(middles_.positions()[kEdges.size() * node + e]);
    const Eigen::Vector3d bulge = 4.0 * middle - 2.0 * (driverNodes[tet[i]] + driverNodes[tet[j]]);
    position += (q[i] * b[j] + b[i] * q[j] - q[i] * q[j]) * bulge;
  }
  return position;
}

}  // namespace tetskin::report
