// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh_skin.h>

#include <vector>

namespace tetskin::report {

/// Where another cage of the same mesh takes the nodes of a cage: by the quadratic map of one of its tets, continued to
/// first order where the node lies outside. Where cages have duplicate elements, the position of a node does not
/// determine which duplicate of a tet is meant: it is the one reached from the nearest vertex of the mesh in the node's
/// own tets.
class DrivenNodes {
 public:
  /// driver  with `vertexTets`; outlives this object
  /// cage    with `vertexTets`; without them, its nodes are assigned by position
  /// Throws InputError
  DrivenNodes(const TriangleMesh& mesh, const Cage& driver, const Cage& cage);

  /// Node positions for these nodes of the driver, nodeCount. Throws InputError if these are not finite.
  std::vector<Eigen::Vector3f> positionsAt(const std::vector<Eigen::Vector3d>& driverNodes);

 private:
  struct Position {
    int tet = -1;
    Eigen::Vector4d weights, nearest;  ///< barycentric weights of the node, and of a point near it in the tet
  };

  void placeNodes(const TriangleMesh& mesh, const Cage& cage);
  void bindCentroids();
  Eigen::Vector3d positionOf(std::size_t node, const std::vector<Eigen::Vector3d>& driverNodes) const;

  const Cage& driver_;
  std::vector<Position> positions_;
  MeshSkin<double> centroids_;  ///< of the six edges of each node's tet; with its corners they determine its map
};

}  // namespace tetskin::report
