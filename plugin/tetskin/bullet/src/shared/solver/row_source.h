// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: what a DeformableSolver solves for in a step, beside what bodies meet of rigid ones.
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <tetskin/bullet/src/shared/bodies/point_contacts.h>
#include <tetskin/bullet/src/shared/forces/body_forces.h>

class btSoftBody;

namespace tetskin {

/// A point of one soft body that is to stay outside of another, or of another part of its own. `object` is that body.
struct SoftPointContact : PointContact {
  btSoftBody* body = nullptr;               ///< awake
  std::array<int, 4> objectNodes{};         ///< of the tet that the point is in
  std::array<btScalar, 4> objectWeights{};  ///< sum 1
};

/// A point of a soft body that is held to a point of a rigid object, or to one in space. World space.
struct PointJoint {
  btSoftBody* body = nullptr;
  std::uint32_t nodeCount = 0;                          ///<
  std::array<int, kMaxPointNodes> nodes{};              ///< of the body
  std::array<btScalar, kMaxPointNodes> weights{};       ///< sum 1; some may be below 0
  const btCollisionObject* object = nullptr;            ///< null: a point in space, which stands
  btVector3 anchor{0, 0, 0};                            ///< of the object, when the step begins
  btVector3 offset{0, 0, 0};                            ///< of the body's point from there; what is to be taken back
  btScalar stiffness = 0;                               ///< impulse over velocity; 0: as stiff as need be
  btScalar most = BT_LARGE_FLOAT;                       ///< of the impulse
  btMatrix3x3 directions = btMatrix3x3::getIdentity();  ///< a projection: along which it is held
  /// Of the object on the soft body in the step: force times seconds. Written by the solver, unless it is constant.
  btVector3 impulse{0, 0, 0};
  bool constant = false;  ///< a load: nothing is held, the impulse is given
};

/// In the world's list of forces, where a DeformableSolver finds it and asks it in each step. It is no force itself.
class TETSKIN_BULLET_API RowSource : public SilentForce {
 public:
  /// Positions are those that the step begins with, velocities those that bodies would end it with alone. What is
  /// returned lives until the next call; the solver writes the impulses.
  virtual std::vector<SoftPointContact>* contacts(btScalar /*seconds*/) { return nullptr; }
  virtual std::vector<PointJoint>* joints(btScalar /*seconds*/) { return nullptr; }
  /// Impulses are written.
  virtual void finish(btScalar /*seconds*/) {}

  /// Bodies are in it by its owner's will alone.
  void addSoftBody(btSoftBody*) override {}
};

}  // namespace tetskin
