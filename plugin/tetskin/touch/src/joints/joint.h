// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: the joints at a point of a surface: springs, ball joints, welds.
//
// A spring is a row with the impulse -c (u + q s / dt), where c = dt (k dt + d), s is the offset from the anchor to the
// point, u the point's velocity relative to the anchor's at the end of the step, and q = k dt / (k dt + d), which is 1
// without damping. It is implicit in both velocities, so it is stable at any stiffness.
//
// A weld is three such rows, with the solver's stiffness for joints: one at the point, in all directions; one at a
// point beside it along the anchor's x, in y and z; and one at a point along its y, in z. Together they constrain six
// directions, all degrees of freedom of a rigid motion.
#pragma once

#include <tetskin/solver/src/base/row_source.h>
#include <tetskin/touch/src/joints/joint_anchor.h>
#include <tetskin/touch/src/points/point_jacobian.h>

#include <limits>

namespace tetskin::touch_detail {

struct JointSettings {
  bool turns = false;                                         ///< true for a weld, which also constrains rotation
  double stiffness = 10;                                      ///< of springs: see SurfaceSpringOptions
  double damping = 0;                                         ///< of springs: see SurfaceSpringOptions
  double maxForce = std::numeric_limits<double>::infinity();  ///< of springs: see SurfaceSpringOptions
  bool collide = false;
};

/// Acts while it is among the rows of its world.
class Joint {
 public:
  /// The point's status must be Ok.
  Joint(const SurfacePoint& point, const JointAnchor& anchor, const JointSettings& settings);
  ~Joint();
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  const SurfacePoint& point() const { return point_; }
  JointAnchor& anchor() { return anchor_; }
  const JointAnchor& anchor() const { return anchor_; }
  JointSettings& settings() { return settings_; }
  bool dropped() const { return dropped_; }
  /// The force on the point in the last step in which the body was awake.
  const btVector3& force() const { return force_; }
  const btVector3& torque() const { return torque_; }
  /// The current offset from the anchor to the point. The point's status must be Ok.
  btVector3 offset() const;
  /// For a weld: the angle between the current and the initial rotation of the point relative to the anchor, in
  /// radians.
  btScalar turn() const;

  /// The body on which it acts; null if the body has been destroyed.
  btSoftBody* body() const { return dropped_ ? nullptr : point_.body(); }
  /// True if its body lives and is in the world in which the joint was created.
  bool isInWorld() const;
  /// Called when its body has left the world and may be destroyed unnoticed.
  void drop();
  /// Adds the constraints of the step.
  void addJoints(btScalar seconds, std::vector<bullet_detail::PointJoint>& joints);
  /// joints  those that addJoints has added, with their impulses
  void finish(btScalar seconds, const bullet_detail::PointJoint* joints);
  void shift(const btVector3& by);
  /// Writes or reads, for snapshots, what changes.
  void serialize(bullet_detail::WorldStream& stream);
  /// Writes what does not change, and must be the same in the world in which a snapshot is restored.
  void checkState(bullet_detail::WorldStream& stream);

 private:
  bullet_detail::CarriedPoint carriedPoint() const;
  bullet_detail::CarriedPoint pointBeside(const btVector3& at) const;
  void weld();
  void wake();
  bullet_detail::PointJoint rowOf(const bullet_detail::CarriedPoint& point, const btVector3& anchor) const;
  void makeSpring(btScalar seconds, bullet_detail::PointJoint& row) const;

  SurfacePoint point_;
  const btSoftBodySolver* solver_;  ///< of the world in which the joint acts
  JointAnchor anchor_;
  JointSettings settings_;
  double nodeMass_;  ///< mean mass of the body's nodes that can move
  bool dropped_ = false;
  bool hidden_ = false;  ///< this joint keeps the body and the object from colliding
  bullet_detail::CarriedPoint carried_;
  btScalar arm_ = 0;  ///< of a weld: distance of the other two points; 0: the weld holds the point only
  bullet_detail::CarriedPoint beside_[2];  ///< of a weld: the other two points
  btTransform anchorBefore_;               ///< in world space, when last read
  int added_ = 0;                          ///< rows added in this step
  bool slept_ = false;                     ///< the body slept when this step began: its forces stay as they are
  btVector3 force_{0, 0, 0}, torque_{0, 0, 0};
};

}  // namespace tetskin::touch_detail
