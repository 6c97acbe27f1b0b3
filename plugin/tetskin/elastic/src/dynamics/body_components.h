// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The components of a body, nodes that tets connect, and the rigid motion of each over a step.
#pragma once

#include <tetskin/elastic/src/dynamics/component_motion.h>
#include <tetskin/elastic/src/dynamics/node_places.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>
#include <tetskin/elastic/src/tets/material.h>

#include <array>
#include <functional>
#include <vector>

namespace tetskin::elastic_detail {

/// A point of a body where something resists a change of its velocity.
template <class S>
struct HeldPoint {
  const int* nodes = nullptr;
  const S* weights = nullptr;
  std::size_t nodeCount = 0;
  std::array<double, 9> stiffness{};  ///< symmetric: impulse on the body per change of velocity, opposite to it
  std::array<double, 3> change{};     ///< result: change of the point's velocity
};

/// The impulse, in a step, of everything but elasticity on a node; empty: nothing has acted.
using NodeImpulse = std::function<std::array<double, 3>(std::size_t node)>;

/// The nodes of a body, of which the matrix knows the masses.
template <class S>
struct NodeStates {
  const BlockMatrix<S>& matrix;
  const NodePlaces<S>& places;         ///< at the beginning of the step
  const AlignedVector<S>& velocities;  ///< 4 scalars per slot
};

/// Solutions are velocities relative to the nodes' `velocities`, in the wide layout.
template <class S>
class BodyComponents {
 public:
  BodyComponents(const RestTets& rest, const BlockMatrix<S>& matrix);

  std::size_t count() const { return motions_.size(); }
  std::size_t of(std::size_t slot) const { return partOf_[slot]; }
  /// By slot. Slots without a node, which have no mass, count as part of the first component.
  const std::vector<std::uint32_t>& bySlot() const { return partOf_; }
  void setStiffness(const RestTets& rest, const Lame& lame, const BlockMatrix<S>& matrix);
  /// True if each has a pinned node.
  bool areHeld(const BlockMatrix<S>& matrix) const;

  /// Finds the rigid motions of a step; the other functions are about them.
  /// pinned  some node is pinned
  void find(const NodeStates<S>& nodes, bool pinned, double seconds);
  /// Makes the velocities those of the rigid motions.
  /// moved     becomes the nodes' displacements at the end of the step, see NodePlaces
  /// relative  becomes the velocities before, minus those of the rigid motions
  void move(const BlockMatrix<S>& matrix, double seconds, NodePlaces<S>& places, AlignedVector<S>& velocities,
            AlignedVector<S>& moved, AlignedVector<S>& relative) const;

  /// The largest sum of V (2 mu + lambda) over a component's tets, divided by its least moment of inertia: times dt^2,
  /// how much rotation is taken for strain.
  double stiffnessOverInertia() const;
  double largestRadius() const;
  /// Circular frequency of a component that hits something: half a period is what a pressure wave takes through it and
  /// back. 0 without mass.
  double impactFrequency(std::size_t component) const;
  /// The same half a period in seconds, of all of it together; 0 without stiffness.
  double impactSeconds(double mass, double radius) const;
  /// By component: rotations of the step, stored by rows.
  std::vector<std::array<double, 9>> turns() const;
  double mass(std::size_t component) const { return motions_[component].mass(); }
  /// See `ComponentMotion::compliance`.
  double compliance(std::size_t component, const std::array<double, 3>& point,
                    const std::array<double, 3>& direction) const;
  const Eigen::Vector3d& centre(std::size_t component) const { return motions_[component].about(); }
  /// The motion of a component as a rigid body, at the beginning of the step, or of the solution.
  RigidVelocity ownVelocity(std::size_t component) const { return motions_[component].own(); }
  /// The kinetic energy of velocities beside these motions, in joules.
  double energyBesideRigid(const NodeStates<S>& nodes) const;
  RigidVelocity solvedVelocity(const NodeStates<S>& nodes, std::size_t component, const S* solution) const;
  /// Changes velocities at the beginning of the step by an impulse on the component as a rigid body.
  void push(const NodeStates<S>& nodes, std::size_t component, const Eigen::Vector3d& point,
            const Eigen::Vector3d& impulse, AlignedVector<S>& velocities) const;
  /// See `BodyDynamics::rigidMotions`.
  /// moved  displacements at which the motions are taken
  bool rigidMotions(const NodeStates<S>& nodes, std::size_t component, const AlignedVector<S>& moved,
                    AlignedVector<S> (&motions)[6]) const;

  // See the functions of BodyDynamics with these names.
  void bendTurns(const NodeStates<S>& nodes, double seconds, S* solution) const;
  void projectToRigidMotion(const NodeStates<S>& nodes, S* solution) const;
  void removeMomentum(const NodeStates<S>& nodes, const NodeImpulse& impulse,
                      const std::vector<std::array<double, 3>>& torques, std::vector<HeldPoint<S>>* held,
                      S* solution) const;

  void carry(const Eigen::Matrix3d& turn, const Eigen::Vector3d& by);
  void serialize(StateStream& stream);

 private:
  std::vector<ComponentMomentum> momenta(const NodeStates<S>& nodes, const S* solution, bool withRigid) const;
  template <class Change>
  void changeSolution(const NodeStates<S>& nodes, const std::vector<RigidVelocity>& velocities, S* solution,
                      Change&& change) const;
  std::vector<ComponentMoments> momentsOf(const NodeStates<S>& nodes) const;
  std::vector<Resistance> resistanceOf(const NodeStates<S>& nodes, const std::vector<HeldPoint<S>>& held) const;
  std::size_t componentOf(const NodeStates<S>& nodes, const HeldPoint<S>& point) const;

  std::vector<std::uint32_t> partOf_;     ///< by slot
  std::vector<ComponentMotion> motions_;  ///< by component
  std::vector<double> stiffness_;         ///< by component: sum of V (2 mu + lambda) over its tets
};

}  // namespace tetskin::elastic_detail
