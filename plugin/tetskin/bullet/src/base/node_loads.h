// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For other libraries: constant forces on nodes that act for a number of steps. The solver owns them, so that a
// snapshot holds those that act, and brings them back.
#pragma once

#include <tetskin/bullet/src/base/row_source.h>
#include <Eigen/Core>

#include <functional>
#include <memory>
#include <vector>

namespace tetskin {
class DeformableSolver;
}

namespace tetskin::bullet_detail {

class WorldStream;
struct Placement;

struct NodePush {
  int node = 0;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
};
using NodePushes = std::vector<NodePush>;  ///< a node may have several

/// Those of one solver. It is not in the list of forces.
class NodeLoads : public RowSource {
 public:
  void add(btSoftBody& body, NodePushes forces, int steps);
  bool empty() const { return loads_.empty(); }
  void drop(const btSoftBody& body);
  /// Drops loads on bodies that are not in their world any more.
  void dropAllBut(const btAlignedObjectArray<btSoftBody*>& world);

  std::vector<PointJoint>* joints(btScalar seconds) override;
  void visitState(WorldStream& stream) override;

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

namespace tetskin {

template <>
struct Access<DeformableSolver> {
  /// Applies forces in the next steps. Wakes the body, which is in the solver's world.
  /// forces  world space, mass times length / s^2
  /// steps   1 or more
  static TETSKIN_BULLET_API void addLoads(DeformableSolver& solver, btSoftBody& body, bullet_detail::NodePushes forces,
                                          int steps);
  /// Forgets all that the solver remembers of a body, and what acts on it for a number of steps. Not within a step.
  static void reset(DeformableSolver& solver, btSoftBody& body);
  /// Forgets what the body has touched, and how it has slept; takes the nodes that are led along. Not within a step.
  /// moveNodes  moves the nodes of the body
  static void teleport(DeformableSolver& solver, btSoftBody& body, const bullet_detail::Placement& placement,
                       const std::function<void()>& moveNodes);
  /// Moves everything in the world. Not within a step.
  static void shift(DeformableSolver& solver, btDeformableMultiBodyDynamicsWorld& world, const btVector3& by);
};

}  // namespace tetskin
