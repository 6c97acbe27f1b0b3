// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For other libraries: constant forces on nodes, for a number of steps. The solver owns them, so that a snapshot holds
// and restores the active ones.
#pragma once

#include <tetskin/solver/src/base/row_source.h>
#include <Eigen/Core>

#include <vector>

namespace tetskin::bullet_detail {

class WorldStream;

struct NodePush {
  int node = 0;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
};
using NodePushes = std::vector<NodePush>;  ///< a node may have several

/// The loads of one solver. It is not in the list of forces.
class NodeLoads : public RowSource {
 public:
  void add(btSoftBody& body, NodePushes forces, int steps);
  bool empty() const { return loads_.empty(); }
  void drop(const btSoftBody& body);
  /// Drops loads on bodies that are no longer in their world.
  void dropAllBut(const btAlignedObjectArray<btSoftBody*>& world);

  std::vector<PointJoint>* joints(btScalar seconds) override;
  void serialize(WorldStream& stream) override;

 private:
  struct Load {
    btSoftBody* body = nullptr;
    NodePushes forces;
    int left = 0;  ///< steps
  };
  std::vector<Load> loads_;
  std::vector<PointJoint> joints_;
};

}  // namespace tetskin::bullet_detail
