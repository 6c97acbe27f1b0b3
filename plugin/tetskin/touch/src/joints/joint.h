// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: what holds a point of a surface to something: springs, ball joints, welds.
//
// A spring is a row: with c = dt (k dt + d), the impulse -c (u + q s / dt), s the way from the anchor to the point, u
// the point's velocity over the anchor's at the end of the step, and q = k dt / (k dt + d), of k alone where nothing
// damps. It is implicit in both velocities, so that it is stable at any stiffness.
//
// A weld is three such rows, as stiff as the solver takes for joints: of the point, in all directions; of a point
// beside it along the anchor's x, in y and z; of one along its y, in z. Six directions, as many as there are to hold.
#pragma once

#include <tetskin/touch/src/forces/touch_force.h>
#include <tetskin/touch/src/joints/joint_anchor.h>
#include <tetskin/touch/src/points/lever.h>

#include <limits>

namespace tetskin::touch_detail {

struct JointSettings {
  bool turns = false;                                         ///< a weld: about, too
  double stiffness = 10;                                      ///< as SurfaceSpringOptions; of springs
  double damping = 0;                                         ///< likewise
  double maxForce = std::numeric_limits<double>::infinity();  ///< likewise
  bool collide = false;
};

class Joint : public Acting {
 public:
  /// The point is Ok.
  Joint(const SurfacePoint& point, const JointAnchor& anchor, const JointSettings& settings);
  ~Joint() override;
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  const SurfacePoint& point() const { return point_; }
  JointAnchor& anchor() { return anchor_; }
  const JointAnchor& anchor() const { return anchor_; }
  JointSettings& settings() { return settings_; }
  bool dropped() const { return dropped_; }
  /// Of the last step, on the point.
  const btVector3& force() const { return force_; }
  const btVector3& torque() const { return torque_; }
  /// From the anchor to the point, now. The point must be Ok.
  btVector3 offset() const;
  /// Of a weld: the angle by which the two have turned to each other, in radians.
  btScalar turn() const;

  btSoftBody* body() const override { return dropped_ ? nullptr : point_.body(); }
  void drop() override;
  bool spent() const override { return !body(); }
  void addJoints(btScalar seconds, std::vector<PointJoint>& joints) override;
  void finish(btScalar seconds, const PointJoint* joints) override;

 private:
  /// Carried by nodes.
  struct Carried {
    std::uint32_t nodeCount = 0;
    std::array<int, kMaxPointNodes> nodes{};
    std::array<btScalar, kMaxPointNodes> weights{};
  };
  Carried carriedPoint() const;
  Carried pointBeside(const btVector3& at) const;
  btVector3 positionOf(const Carried& point) const;
  btVector3 velocityOfPoint() const;
  void weld();
  void wake();
  PointJoint rowOf(const Carried& point, const btVector3& anchor) const;
  void makeSpring(btScalar seconds, PointJoint& row) const;

  SurfacePoint point_;
  JointAnchor anchor_;
  JointSettings settings_;
  double nodeMass_;  ///< the mean
  bool dropped_ = false;
  bool hidden_ = false;  ///< body and object do not collide, by us
  Carried carried_;
  btScalar arm_ = 0;          ///< of a weld: how far beside the other two are; 0: it holds the point alone
  Carried beside_[2];         ///< of a weld
  btTransform anchorBefore_;  ///< in world space, when last looked at
  int added_ = 0;             ///< rows in this step
  btVector3 force_{0, 0, 0}, torque_{0, 0, 0};
};

}  // namespace tetskin::touch_detail
