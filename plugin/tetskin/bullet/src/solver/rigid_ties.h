// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: dynamic rigid bodies are solved for together with the nodes that contacts bind to them.
//
// Bullet's contacts push single nodes, and what they leave is not what bodies of tets push back with. The nodes' solve
// would take a rigid body for as fast as contacts have left it, however light, and keep the difference to itself. So
// the rigid body is an unknown of the solve. Nodes are bound to it by
//   f = -W (v - J V) + h,    M (V - V0) = -sum J^T f,
// with v a node's velocity, J V that of the rigid body where it is met, W stiff in the directions in which the contact
// binds and as friction is in those in which it slides, h what keeps the velocity apart that contacts want, and V0
// without the impulses of Bullet's contacts. V is eliminated: W on the diagonal, and an addition of rank 6 for each
// rigid body to the matrices' products.
#pragma once

#include <tetskin/bullet/src/solver/solver_bodies.h>

#include <Eigen/Core>
#include <unordered_map>

class btDeformableContactProjection;
class btRigidBody;

namespace tetskin {

/// A node that is bound to a rigid body. World space.
struct RigidTie {
  std::size_t body = 0;  ///< in SolverBodies::bodies
  std::size_t node = 0;  ///< of the body
  btVector3 normal;      ///< of one of its contacts
  btVector3 arm;         ///< from the rigid body's centre to where it is met
  btVector3 relative;    ///< velocity over the rigid body's there, with which the step begins
  btMatrix3x3 weight;    ///< W
  btVector3 wanted;      ///< h
};

/// Velocity, angular velocity; force, torque.
using RigidVector = Eigen::Matrix<double, 6, 1>;

struct TiedRigid {
  btRigidBody* rigid = nullptr;
  std::vector<RigidTie> ties;
  /// What acts on it but for the solution, times the step: what its contacts have given it, and is undone, and the
  /// reaction to where the ties begin.
  RigidVector known = RigidVector::Zero();
  Eigen::Matrix<double, 6, 6> compliance;  ///< (M + sum J^T W J)^-1
};

/// Those of a step. A rigid body is tied if it is free to move, and nothing but nodes of bodies that are solved for has
/// a part in where it goes: no joint of the world, no anchor, no point or weld of tetskin::touch and no other contact,
/// for which the solve cannot speak.
class RigidTies {
 public:
  /// Finds them, and adds their weights to the matrices. After velocities have been read, and before anything is added
  /// to matrices.
  void collect(const btDeformableContactProjection& projection, const ForceList& forces, SolverBodies& bodies);
  bool ties(int number) const { return numbers_.count(number) != 0; }
  const std::vector<TiedRigid>& rigids() const { return rigids_; }

  /// What ties do at the solutions as they are, but for W times these.
  /// residual  by node number
  void addForces(const std::vector<std::size_t>& rigids, const SolverBodies& bodies, VectorStack& residual) const;
  /// Adds to the products of the matrices with their own steps.
  /// products  by body, wide
  void addProducts(const std::vector<std::size_t>& rigids, const SolverBodies& bodies,
                   std::vector<std::vector<btScalar>>& products) const;
  /// The rigid bodies' velocities, and the normal impulses of nodes, of the solution.
  void finish(SolverBodies& bodies) const;

 private:
  void listRigids(const btDeformableContactProjection& projection, const SolverBodies& bodies);
  void dropOthers(const btDeformableContactProjection& projection, const SolverBodies& bodies);
  void dropMoved(const ForceList& forces);
  void dropOfWorlds(const SolverBodies& bodies);
  void listNodes(const btDeformableContactProjection& projection, const SolverBodies& bodies);
  void makeTies(const btDeformableContactProjection& projection, SolverBodies& bodies);
  void addWeights(SolverBodies& bodies);

  std::vector<TiedRigid> rigids_;
  std::unordered_map<const btCollisionObject*, std::size_t> places_;  ///< in `rigids_`
  struct Place {
    std::size_t rigid = 0;
    std::size_t tie = 0;  ///< of the rigid body's, from 1; 0: none yet
  };
  std::unordered_map<int, Place> numbers_;  ///< by node number
};

}  // namespace tetskin
