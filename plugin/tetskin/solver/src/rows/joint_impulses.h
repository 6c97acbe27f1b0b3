// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the impulses that Bullet's solve has applied in each row of a joint. A motor's limit
// bounds its impulse in Bullet's solve and in this one together, and a stop can take back what it has pushed.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <array>
#include <deque>
#include <vector>

class btDiscreteDynamicsWorld;

namespace tetskin::bullet_detail {

/// The rows of a joint, in the form that Bullet's solver asks for.
struct JointRows {
  /// One row for each degree of freedom; and the number of btScalars from one row to the next.
  static constexpr std::size_t kMaxRows = 6, kStride = 16;
  using Values = std::array<btScalar, kMaxRows * kStride>;

  std::size_t count = 0;  ///< rows in use; 0 if the joint has none, or more than kMaxRows
  Values linearA{}, angularA{}, linearB{}, angularB{}, rest{}, softness{}, lowest{}, highest{};

  JointRows(btTypedConstraint& joint, btScalar seconds);
  btVector3 vector(const Values& from, std::size_t row) const;
  btScalar number(const Values& from, std::size_t row) const;
  /// True if a row's impulse is bounded: that of a motor, or of a stop.
  bool isBounded(std::size_t row) const;
  /// Velocity of a row at the bodies' present velocities.
  btScalar velocity(const btTypedConstraint& joint, std::size_t row) const;
};

/// Makes Bullet report the forces of joints while it solves. A joint without a `btJointFeedback` of the application's
/// is lent one from `begin` to `end`.
class JointImpulses {
 public:
  /// Before Bullet's solve. Cost O(joints).
  void begin(const std::vector<btDiscreteDynamicsWorld*>& worlds);
  void end();
  /// Impulses of all rows since `begin`, after Bullet's solve. Zero for a joint that was not there at `begin`.
  static std::array<btScalar, JointRows::kMaxRows> of(const btTypedConstraint& joint, const JointRows& rows,
                                                      btScalar seconds);

 private:
  std::deque<btJointFeedback> lent_;  // a deque keeps their addresses
  std::vector<btTypedConstraint*> joints_;
};

}  // namespace tetskin::bullet_detail
