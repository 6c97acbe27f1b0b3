// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/mesh.h>

#include <vector>

#include "scenes/world.h"

namespace tetskin::scenes {

/// The mapping from a model's own space, where it may have any size and position, to Bullet's world, and back.
struct Placement {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< model's space; goes to `offset`
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< position of the model's `centre` in world space
  double scale = 1.0;                                ///< length in the world over length in the model

  Eigen::Vector3d toWorld(const Eigen::Vector3d& p) const { return scale * (p - centre) + offset; }
  Eigen::Vector3d toModel(const Eigen::Vector3d& p) const { return (p - offset) / scale + centre; }
  void toWorld(std::vector<Eigen::Vector3d>& points) const;
  void toModel(std::vector<Eigen::Vector3d>& points) const;
  Cage toWorld(Cage cage) const;

  /// A skin's surface in the model's space, vertexCount positions.
  void readSurface(const SoftBodySkin& skin, std::vector<Eigen::Vector3d>& surface) const;
};

/// A body's nodes at present, world space.
template <class Scalar = double>
std::vector<Eigen::Matrix<Scalar, 3, 1>> nodesOf(const btSoftBody& body) {
  const PointView<const btScalar> view = nodePositions(body);
  std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
  nodes.reserve(view.size());
  for (std::size_t n = 0; n < view.size(); ++n) {
    nodes.emplace_back(Eigen::Map<const Eigen::Matrix<btScalar, 3, 1>>(view[n]).template cast<Scalar>());
  }
  return nodes;
}

/// The placement of a rigid body, in the form of pages and GLB.
Eigen::Affine3d affineOf(const btTransform& transform);

/// Scales a box to kSize, and puts its centre at the origin.
Placement placementOf(const Box3& box);

}  // namespace tetskin::scenes
