// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: rigid bodies and multibodies that a step solves for together with the soft bodies in
// contact with them.
//
// The unknowns are the changes of their velocities by the solve, relative to the velocities that Bullet has found. They
// have few degrees of freedom, and are eliminated: with J the derivative of the velocity of a row's point by the
// unknowns, H the stiffness of the row and M the masses,
//   (M + sum J^T H J) dV = sum J^T f,    dV = (1 + M^-1 sum J^T H J)^-1 M^-1 sum J^T f
// which contains only inverse masses, so that an axis may be locked.
#pragma once

#include <LinearMath/btTransform.h>
#include <tetskin/core/src/base/arithmetic/small_matrix.h>
#include <tetskin/solver/src/search/kinematic_paths.h>

#include <Eigen/Core>
#include <memory>
#include <unordered_map>
#include <vector>

class btCollisionObject;
class btMultiBody;
class btRigidBody;

namespace tetskin::bullet_detail {

struct RigidPoint {
  int unknown = -1;   ///< index in RigidUnknowns; below 0: the object's motion is prescribed
  btVector3 arm;      ///< of a rigid body: from its centre of mass
  int jacobian = -1;  ///< of a link of a multibody: index in RigidUnknowns
};

/// A rigid body or a whole multibody.
struct RigidUnknown {
  btRigidBody* rigid = nullptr;
  btMultiBody* multiBody = nullptr;
  Eigen::Index size = 6;        ///< degrees of freedom
  Eigen::Index first = 0;       ///< index of the first in its system's vectors
  Eigen::MatrixXd inverseMass;  ///< size x size
  /// Angular velocities of a multibody's base and links before the solve, in their own frames; empty until needed.
  std::vector<btVector3> turning;
};

/// The derivative of the velocity of a point of a rigid body by the body's velocities.
Small3x6 bodyJacobian(const RigidPoint& at);

class RigidUnknowns {
 public:
  /// The derivative of a point's velocity by those of its unknown: 3 x size.
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  /// Call it when the rows of a step are collected.
  void clear();

  /// The point of an object at a position. An object that is free to move becomes an unknown.
  RigidPoint at(const btCollisionObject& object, const btVector3& position);
  /// Its index in `list`; negative if the object is not an unknown (yet).
  int find(const btCollisionObject& object) const;
  /// For a RigidPoint of a rigid body: a row of a joint, whose velocity has an x component only.
  int addScalarJacobian(const btVector3& linear, const btVector3& angular);
  /// The velocity of the object at the point, as Bullet has left it: along the straight path that the point takes in
  /// the step.
  btVector3 velocityAt(const RigidPoint& at, const btCollisionObject& object, btScalar seconds);

  /// Where the object is at the beginning of the step.
  const btTransform& startOf(const btCollisionObject& object) const { return paths_->startOf(object); }
  /// True if the object is kinematic and moves in this step: Bullet already has it at its place at the end of the step.
  bool isLed(const btCollisionObject& object) const;
  KinematicPaths& paths() { return *paths_; }
  const std::shared_ptr<KinematicPaths>& sharedPaths() const { return paths_; }

  /// The identity of a body: the rigid body itself, or the multibody of a link.
  static const void* keyOf(const btCollisionObject& object);
  static const void* keyOf(const RigidUnknown& unknown);

  const std::vector<RigidUnknown>& list() const { return unknowns_; }
  std::vector<RigidUnknown>& list() { return unknowns_; }
  Jacobian jacobianOf(const RigidPoint& at) const;
  static Jacobian toJacobian(const Small3x6& of);

  // The functions below use vectors of a system: the unknowns' indices in it must have been set.
  /// The change of the point's velocity due to changed velocities of the unknowns.
  btVector3 velocity(const RigidPoint& at, const Eigen::VectorXd& change) const;
  /// Adds J^T times the impulse on the object.
  void addImpulse(const RigidPoint& at, const btVector3& impulse, Eigen::VectorXd& to) const;
  /// By how much a unit impulse at the point changes the point's velocity in a direction.
  double compliance(const RigidPoint& at, const btVector3& direction) const;
  /// Gives an object an impulse at a point, in Bullet.
  void push(const RigidPoint& at, const btVector3& impulse) const;
  /// Applies a change of velocities to a body in Bullet.
  static void apply(const RigidUnknown& unknown, const Eigen::VectorXd& change);

 private:
  int add(const btCollisionObject& object);
  btVector3 carriedBy(const btRigidBody& body, const btVector3& arm, const btVector3& velocity, btScalar seconds) const;
  btVector3 turningOf(const btCollisionObject& link, RigidUnknown& unknown);
  int addLinkPoint(const btCollisionObject& object, const btVector3& position);

  std::vector<RigidUnknown> unknowns_;
  std::unordered_map<const void*, int> indices_;  ///< index in the list, by rigid body or multibody
  std::vector<Jacobian> jacobians_;
  std::vector<btVector3> moving_;  ///< scratch: velocities of links, which Bullet computes together with `turning`
  std::shared_ptr<KinematicPaths> paths_ = std::make_shared<KinematicPaths>();
};

}  // namespace tetskin::bullet_detail
