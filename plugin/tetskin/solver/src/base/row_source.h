// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: the constraints that a DeformableSolver solves for in a step, in addition to contacts with
// rigid objects.
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <tetskin/core/types.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/point_contacts.h>

class btSoftBody;

namespace tetskin::bullet_detail {

/// The product a a^T, which projects onto the direction of a unit vector.
inline btMatrix3x3 outerSquare(const btVector3& a) {
  return {a.x() * a.x(), a.x() * a.y(), a.x() * a.z(), a.y() * a.x(), a.y() * a.y(),
          a.y() * a.z(), a.z() * a.x(), a.z() * a.y(), a.z() * a.z()};
}

/// A constraint between a point of a soft body and a point of a rigid object, or a point in space. World space.
struct PointJoint {
  btSoftBody* body = nullptr;
  CarriedPoint at;                            ///< the body's point
  const btCollisionObject* object = nullptr;  ///< null: a point in space, which does not move
  btVector3 anchor{0, 0, 0};                  ///< on the object, when the step begins
  btVector3 offset{0, 0, 0};                  ///< on the object, at the beginning of the step
  btScalar stiffness = 0;                     ///< from there to the body's point; the constraint drives it to 0
  btScalar maximum = BT_LARGE_FLOAT;          ///< bound of the impulse
  btMatrix3x3 directions = btMatrix3x3::getIdentity();  ///< projection to the constrained directions
  /// The impulse of the object on the soft body in the step: force times seconds. The solver writes it, unless it is
  /// constant.
  btVector3 impulse{0, 0, 0};
  bool constant = false;  ///< a load: a given impulse, not a constraint
};

/// An entry in the world's list of forces, in which a DeformableSolver finds it; the solver calls it in each step. It
/// applies no force itself.
class TETSKIN_SOLVER_API RowSource : public InactiveForce {
 public:
  /// Contacts of points of awake soft bodies with soft bodies: another one, or another part of the same one. Positions
  /// are those at the beginning of the step; velocities are those at its end if there were no constraints. The result
  /// stays valid until the next call; the solver writes the impulses.
  /// threads  of the solver, or null
  virtual PointContacts* contacts(btScalar /*seconds*/, ParallelFor* /*threads*/) { return nullptr; }
  virtual std::vector<PointJoint>* joints(btScalar /*seconds*/) { return nullptr; }
  /// Called when the impulses have been written.
  virtual void finish(btScalar /*seconds*/) {}

  /// Only the owner of this object adds bodies to it.
  void addSoftBody(btSoftBody*) override {}
};

}  // namespace tetskin::bullet_detail
