// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: where a body's nodes are, and where a step would take them, in arrays of their own,
// with a hierarchy over them. Bullet's nodes are 300 bytes apart, and its tree of nodes would have to be refitted,
// walked and dereferenced leaf by leaf.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/core/src/base/bvh/bvh.h>

#include <vector>

namespace tetskin::bullet_detail {

/// The position of a node at the beginning of a step, and the one that it reaches without contact. World space.
struct NodeTravel {
  btVector3 now, predicted;
};

class NodePaths {
 public:
  /// Forgets the paths of the step before.
  /// Returns  the array to be filled, by node
  std::vector<NodeTravel>& begin(std::size_t nodeCount);

  /// Lists the nodes whose paths may meet the box, by number; nodes outside may be among them.
  /// Returns  valid until the next call
  /// Cost     O(nodes) for the first box of a step, then O(log nodes + listed)
  const std::vector<int>& near(const BvhBox<btScalar>& box);

  const NodeTravel& operator[](int node) const { return travels_[static_cast<std::size_t>(node)]; }
  BvhBox<btScalar> boxOf(int node) const;  ///< around the path of a node

 private:
  void fit();
  void listNear(const BvhBox<btScalar>& box, std::size_t node);

  std::vector<NodeTravel> travels_;      ///< by node
  Bvh tree_;                             ///< by the positions in the first step
  std::vector<BvhBox<btScalar>> boxes_;  ///< around the paths, by node of the tree
  std::vector<int> near_;
  bool fitted_ = false;
};

}  // namespace tetskin::bullet_detail
