// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: one of two that meet in an impact, moving as a rigid body: a component of a soft body,
// a rigid body, a link of a multibody, or something that nothing moves.
#pragma once

#include <tetskin/solver/src/rows/rigid_unknowns.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

namespace tetskin::bullet_detail {

/// A velocity field about the side's centre, wherever that is: x -> linear + field (x - centre).
struct SideMotion {
  btVector3 linear{0, 0, 0};
  btMatrix3x3 field{0, 0, 0, 0, 0, 0, 0, 0, 0};
};

class ImpactSide {
 public:
  /// soft       null: `object` is not a soft body, or its body takes no part in the step
  /// component  of the soft body
  ImpactSide(SolvedBody* soft, std::size_t component, const btCollisionObject& object, RigidUnknowns& rigids)
      : soft_(soft), component_(component), object_(object), rigids_(rigids) {}

  /// Null if it is not a soft body.
  SolvedBody* soft() const { return soft_; }
  /// True if contacts change its motion.
  bool moves() const;
  btScalar mass() const;
  btVector3 centre() const;
  /// At the beginning of the step, with what acts on it beside contacts and elasticity; or as the step has solved it. A
  /// link's is that of the point.
  SideMotion motion(const btVector3& at, bool solved) const;
  /// The velocity of a point by a motion.
  btVector3 velocity(const SideMotion& motion, const btVector3& at) const;
  /// Change of velocity per unit impulse, both at a point and in a direction; 0: nothing moves it.
  btScalar compliance(const btVector3& at, const btVector3& along) const;
  /// Between two steps; of a soft body after its `findMotion`.
  void push(const btVector3& at, const btVector3& impulse) const;
  /// Share of its energy that its material's damping leaves it in an impact.
  double kept(double energy) const;
  /// The energy of its body's deformation and of the motion beside the rigid one, in joules: between two steps, or at
  /// the beginning of one, after its prediction.
  double vibration() const;
  double vibrationBefore() const;

 private:
  SolvedBody* soft_;
  std::size_t component_;
  const btCollisionObject& object_;
  RigidUnknowns& rigids_;
};

}  // namespace tetskin::bullet_detail
