// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/placement.h"

namespace tetskin::scenes {

void Placement::toWorld(std::vector<Eigen::Vector3d>& points) const {
  for (Eigen::Vector3d& p : points) p = toWorld(p);
}

void Placement::toModel(std::vector<Eigen::Vector3d>& points) const {
  for (Eigen::Vector3d& p : points) p = toModel(p);
}

Cage Placement::toWorld(Cage cage) const {
  for (Eigen::Vector3d& node : cage.mesh.nodes) node -= centre;
  cage.scaleBy(scale);
  return cage;
}

void Placement::readSurface(const SoftBodySkin& skin, std::vector<Eigen::Vector3d>& surface) const {
  const PointView<const btScalar> positions = skin.positions();
  surface.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    surface[v] = toModel(Eigen::Map<const Eigen::Matrix<btScalar, 3, 1>>(positions[v]).cast<double>());
  }
}

Eigen::Affine3d affineOf(const btTransform& transform) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row) result.linear().row(row) = toEigen(transform.getBasis()[row]);
  result.translation() = toEigen(transform.getOrigin());
  return result;
}

Placement placementOf(const Box3& box) {
  Placement placement;
  placement.centre = box.center();
  placement.scale = kSize / box.sizes().maxCoeff();
  return placement;
}

}  // namespace tetskin::scenes
