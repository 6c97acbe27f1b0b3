// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: a point tied to something, by a spring along, and for welds by one about, which are
// solved for implicitly, and with the masses of both sides.
//
// In a step the point moves with v, and what it is tied to with u + K (-P), where P is the impulse that the joint gives
// the point, u is what the partner would do without, and K its response. A spring of stiffness k and damping d gives
//     P = dt k (s + dt (u - K P - v)) + dt d (u - K P - v),   s: from point to partner when the step begins
// so that
//     P = (1/c + K)^-1 (q s / dt + u - v),   c = dt (k dt + d),   q = k dt / (k dt + d)
// It is linear in v, which is what the solve of the soft body wants; and however stiff the spring, it only adds the
// partner's mass to the nodes.
#pragma once

#include <tetskin/touch/src/forces/touch_force.h>
#include <tetskin/touch/src/joints/partner.h>
#include <tetskin/touch/src/points/lever.h>

#include <limits>

namespace tetskin::touch_detail {

struct JointSettings {
  bool turns = false;                                         ///< a weld: about, too
  double stiffness = 10;                                      ///< as SurfaceSpringOptions
  double damping = 0;                                         ///< as SurfaceSpringOptions; along only
  double maxForce = std::numeric_limits<double>::infinity();  ///< along only
  bool collide = false;
};

class Joint : public Acting {
 public:
  /// The point is Ok.
  Joint(const SurfacePoint& point, std::unique_ptr<Partner> partner, const JointSettings& settings);
  ~Joint() override;
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  const SurfacePoint& point() const { return point_; }
  Partner& partnerOf() { return *partner_; }
  JointSettings& settings() { return settings_; }
  bool dropped() const { return dropped_; }
  /// Of the last step, on the point: force and moment.
  const Vector6& load() const { return load_; }
  /// From the point to the partner, now: a way and a turn. The point must be Ok.
  Vector6 offset() const;

  btSoftBody* body() const override { return dropped_ ? nullptr : point_.body(); }
  void drop() override;
  bool spent() const override { return !body(); }
  const void* partner() const override { return partner_->mass(); }
  void begin(btScalar dt, int sharers) override;
  void addTo(VectorStack& impulses) override;
  void addResistance(const VectorStack& change, VectorStack& impulses) const override;
  void finish() override;

 private:
  void wake();
  bool softMoves() const;
  Vector6 offsetOf(const Lever& lever) const;
  Vector6 pointVelocity(bool split = true) const;
  /// Of the partner as it is now: what the impulse is made of.
  void measure();
  /// What gives the impulse for an error in velocity, if all of this gives way to it.
  Matrix6 inverse() const;
  /// split  with the velocities by which contacts push bodies apart; else the solve has them already
  Vector6 impulse(bool split = true) const { return matrix_ * (wanted_ - pointVelocity(split)); }
  void spread(const Vector6& impulse, VectorStack& impulses) const;

  SurfacePoint point_;
  std::unique_ptr<Partner> partner_;
  JointSettings settings_;
  double nodeMass_;  ///< the mean
  bool dropped_ = false;
  bool hidden_ = false;  ///< body and partner do not collide, by us
  Lever lever_;
  std::vector<Eigen::Vector3d> places_;  ///< of its nodes when the joint was made; welds only
  btMatrix3x3 turned_;                   ///< the partner then
  btTransform anchorBefore_;             ///< the partner's, when last looked at
  Vector6 load_ = Vector6::Zero();
  double excess_ = 0;  ///< of impulses over what is allowed, not yet made good

  // Of the step.
  bool active_ = false;
  double dt_ = 0;
  int sharers_ = 1;
  Vector6 offset_ = Vector6::Zero();      ///< s
  Vector6 began_ = Vector6::Zero();       ///< v
  Vector6 compliance_ = Vector6::Zero();  ///< 1/c
  Vector6 wanted_ = Vector6::Zero();      ///< q s / dt + u
  Matrix6 response_ = Matrix6::Zero();    ///< K
  Matrix6 matrix_ = Matrix6::Zero();      ///< (1/c + K)^-1
};

}  // namespace tetskin::touch_detail
