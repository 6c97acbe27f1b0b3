// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <tetskin/solver/src/rows/joint_impulses.h>
#include <tetskin/solver/src/rows/smallest_solution.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Writes a vector, scaled by the body's linear or angular factor, into three rows of a column.
void put(double* column, int at, const btVector3& vector, const btVector3& factor) {
  for (int k = 0; k < 3; ++k) column[at + k] = static_cast<double>(vector[k] * factor[k]);
}

}  // namespace

JointRows::JointRows(btTypedConstraint& joint, btScalar seconds) {
  assert(seconds > 0);
  btTypedConstraint::btConstraintInfo1 counts{};
  joint.getInfo1(&counts);
  if (counts.m_numConstraintRows <= 0 || counts.m_numConstraintRows > static_cast<int>(kMaxRows)) return;
  count = static_cast<std::size_t>(counts.m_numConstraintRows);
  lowest.fill(-BT_LARGE_FLOAT);
  highest.fill(BT_LARGE_FLOAT);
  btTypedConstraint::btConstraintInfo2 info;
  info.fps = 1 / seconds;
  info.erp = btScalar(0.2);
  info.m_J1linearAxis = linearA.data();
  info.m_J1angularAxis = angularA.data();
  info.m_J2linearAxis = linearB.data();
  info.m_J2angularAxis = angularB.data();
  info.rowskip = static_cast<int>(kStride);
  info.m_constraintError = rest.data();
  info.cfm = softness.data();
  info.m_lowerLimit = lowest.data();
  info.m_upperLimit = highest.data();
  info.m_damping = 1;
  joint.getInfo2(&info);
}

btVector3 JointRows::vector(const Values& from, std::size_t row) const {
  assert(row < count);
  const std::size_t at = row * kStride;
  return {from[at], from[at + 1], from[at + 2]};
}

btScalar JointRows::number(const Values& from, std::size_t row) const {
  assert(row < count);
  return from[row * kStride];
}

bool JointRows::isBounded(std::size_t row) const {
  return number(lowest, row) > -BT_LARGE_FLOAT || number(highest, row) < BT_LARGE_FLOAT;
}

btScalar JointRows::velocity(const btTypedConstraint& joint, std::size_t row) const {
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  return vector(linearA, row).dot(a.getLinearVelocity()) + vector(angularA, row).dot(a.getAngularVelocity()) +
         vector(linearB, row).dot(b.getLinearVelocity()) + vector(angularB, row).dot(b.getAngularVelocity());
}

void JointImpulses::begin(const std::vector<btDiscreteDynamicsWorld*>& worlds) {
  end();
  for (btDiscreteDynamicsWorld* world : worlds) {
    for (int c = 0; c < world->getNumConstraints(); ++c) {
      btTypedConstraint* joint = world->getConstraint(c);
      if (joint->getJointFeedback()) continue;
      if (lent_.size() == joints_.size()) lent_.emplace_back();
      btJointFeedback& feedback = lent_[joints_.size()];
      feedback.m_appliedForceBodyA.setZero();
      feedback.m_appliedTorqueBodyA.setZero();
      feedback.m_appliedForceBodyB.setZero();
      feedback.m_appliedTorqueBodyB.setZero();
      joint->setJointFeedback(&feedback);
      joints_.push_back(joint);
    }
  }
}

void JointImpulses::end() {
  for (btTypedConstraint* joint : joints_) joint->setJointFeedback(nullptr);
  joints_.clear();
}

/// Bullet reports the sum of all rows on either body; these are the impulses with that sum, the smallest ones if
/// several fit.
std::array<btScalar, JointRows::kMaxRows> JointImpulses::of(const btTypedConstraint& joint, const JointRows& rows,
                                                            btScalar seconds) {
  std::array<btScalar, JointRows::kMaxRows> impulses{};
  const btJointFeedback* told = joint.getJointFeedback();
  if (!told || rows.count == 0) return impulses;
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  SmallestSolution::Columns columns{};
  for (std::size_t k = 0; k < rows.count; ++k) {
    double* column = &columns[SmallestSolution::kRows * k];
    put(column, 0, rows.vector(rows.linearA, k), a.getLinearFactor());
    put(column, 3, rows.vector(rows.angularA, k), a.getAngularFactor());
    put(column, 6, rows.vector(rows.linearB, k), b.getLinearFactor());
    put(column, 9, rows.vector(rows.angularB, k), b.getAngularFactor());
  }
  std::array<double, SmallestSolution::kRows> sum{};
  const btVector3 one(1, 1, 1);
  put(sum.data(), 0, told->m_appliedForceBodyA, one);
  put(sum.data(), 3, told->m_appliedTorqueBodyA, one);
  put(sum.data(), 6, told->m_appliedForceBodyB, one);
  put(sum.data(), 9, told->m_appliedTorqueBodyB, one);
  const auto solved = SmallestSolution(columns, rows.count).solve(sum);
  for (std::size_t k = 0; k < rows.count; ++k) {
    impulses[k] = static_cast<btScalar>(solved[k] * static_cast<double>(seconds));
  }
  return impulses;
}

}  // namespace tetskin::bullet_detail
