// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh_skin.h>

#include <array>
#include <vector>

namespace tetskin::report {

/// The nodes of one cage as another one, of the same mesh, takes them: by the quadratic map of a tet of that, which is
/// continued to first order where the node lies outside. Where cages are split, the place of a node does not tell which
/// copy of a tet is meant: it is the one that is reached from the nearest vertex of the mesh in the node's own tets.
class DrivenNodes {
 public:
  /// driver  with `vertexTets`; outlives this object
  /// cage    with `vertexTets`, or else its nodes go by their place
  /// Throws InputError
  DrivenNodes(const TriangleMesh& mesh, const Cage& driver, const Cage& cage);

  /// Where they are for these nodes of the driver, nodeCount. Throws InputError if these are not finite.
  std::vector<Eigen::Vector3f> positionsAt(const std::vector<Eigen::Vector3d>& driverNodes);

 private:
  struct Place {
    int tet = -1;
    Eigen::Vector4d weights, nearest;  ///< of the node, and of a point near it in the tet
  };

  void placeNodes(const TriangleMesh& mesh, const Cage& cage);
  void bindMiddles();
  Eigen::Vector3d positionOf(std::size_t node, const std::vector<Eigen::Vector3d>& driverNodes) const;

  const Cage& driver_;
  std::vector<Place> places_;
  MeshSkin<double> middles_;  ///< of the six edges of each node's tet, which together with its corners tell its map
};

}  // namespace tetskin::report
