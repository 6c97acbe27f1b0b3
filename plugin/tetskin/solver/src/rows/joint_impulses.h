// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what Bullet's solve has applied in each row of a joint. A motor has no more than its
// limit for Bullet's solve and for this one together, and a stop yields what it has pushed.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <array>
#include <deque>
#include <vector>

class btDiscreteDynamicsWorld;

namespace tetskin::bullet_detail {

/// The rows of a joint, in the form in which Bullet's solver asks for them.
struct JointRows {
  /// One row for each degree of freedom; and btScalars from one to the next.
  static constexpr std::size_t kMaxRows = 6, kStride = 16;
  using Values = std::array<btScalar, kMaxRows * kStride>;

  std::size_t count = 0;  ///< rows in use; 0 if the joint has none, or more than are known
  Values linearA{}, angularA{}, linearB{}, angularB{}, rest{}, softness{}, lowest{}, highest{};

  JointRows(btTypedConstraint& joint, btScalar seconds);
  btVector3 vector(const Values& from, std::size_t row) const;
  btScalar number(const Values& from, std::size_t row) const;
  /// True if a row's impulse is bounded: that of a motor, or of a stop.
  bool isBounded(std::size_t row) const;
  /// Velocity of a row, as the bodies are moving.
  btScalar velocity(const btTypedConstraint& joint, std::size_t row) const;
};

/// Has Bullet tell the forces of joints while it solves. A joint has an application's own `btJointFeedback`, or is lent
/// one for the time between `begin` and `end`.
class JointImpulses {
 public:
  /// Before Bullet's solve. Cost O(joints).
  void begin(const std::vector<btDiscreteDynamicsWorld*>& worlds);
  void end();
  /// Impulses of all rows since `begin`, after Bullet's solve. Zero for a joint that was not there then.
  static std::array<btScalar, JointRows::kMaxRows> of(const btTypedConstraint& joint, const JointRows& rows,
                                                      btScalar seconds);

 private:
  std::deque<btJointFeedback> lent_;  // a deque: their addresses stay the same
  std::vector<btTypedConstraint*> joints_;
};

}  // namespace tetskin::bullet_detail
