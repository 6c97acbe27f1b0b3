// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <tetskin/solver/src/motion/divided_limits.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

btHingeConstraint* hingeOf(btTypedConstraint& joint) {
  return joint.getConstraintType() == HINGE_CONSTRAINT_TYPE ? static_cast<btHingeConstraint*>(&joint) : nullptr;
}

/// Null for a joint that was not there.
template <class Joint, class Limit>
const Limit* limitOf(const std::vector<std::pair<const Joint*, Limit>>& limits, const Joint& joint) {
  for (const auto& [of, limit] : limits) {
    if (of == &joint) return &limit;
  }
  return nullptr;
}

}  // namespace

DividedLimits::DividedLimits(btMultiBodyDynamicsWorld& world, int parts)
    : world_(world), parts_(static_cast<btScalar>(parts)) {
  assert(parts >= 1);
  if (parts == 1) return;
  for (int k = 0; k < world.getNumConstraints(); ++k) {
    btTypedConstraint& joint = *world.getConstraint(k);
    breaking_.emplace_back(&joint, divide(joint.getBreakingImpulseThreshold()));
    joint.setBreakingImpulseThreshold(breaking_.back().second.divided);
    btHingeConstraint* hinge = hingeOf(joint);
    if (!hinge) continue;
    motors_.emplace_back(&joint, divide(hinge->getMaxMotorImpulse()));
    hinge->setMaxMotorImpulse(motors_.back().second.divided);
  }
  for (int k = 0; k < world.getNumMultiBodyConstraints(); ++k) {
    btMultiBodyConstraint& joint = *world.getMultiBodyConstraint(k);
    multibodies_.emplace_back(&joint, divide(joint.getMaxAppliedImpulse()));
    joint.setMaxAppliedImpulse(multibodies_.back().second.divided);
  }
}

DividedLimits::~DividedLimits() {
  if (parts_ == 1) return;
  for (int k = 0; k < world_.getNumConstraints(); ++k) {
    btTypedConstraint& joint = *world_.getConstraint(k);
    const Limit* breaking = limitOf(breaking_, std::as_const(joint));
    if (breaking && joint.getBreakingImpulseThreshold() == breaking->divided) {
      joint.setBreakingImpulseThreshold(breaking->before);
    }
    btHingeConstraint* hinge = hingeOf(joint);
    const Limit* motor = limitOf(motors_, std::as_const(joint));
    if (hinge && motor && hinge->getMaxMotorImpulse() == motor->divided) hinge->setMaxMotorImpulse(motor->before);
  }
  for (int k = 0; k < world_.getNumMultiBodyConstraints(); ++k) {
    btMultiBodyConstraint& joint = *world_.getMultiBodyConstraint(k);
    const Limit* limit = limitOf(multibodies_, std::as_const(joint));
    if (limit && joint.getMaxAppliedImpulse() == limit->divided) joint.setMaxAppliedImpulse(limit->before);
  }
}

/// A joint that never breaks has the largest number as its limit.
DividedLimits::Limit DividedLimits::divide(btScalar limit) const {
  return {limit, limit < BT_LARGE_FLOAT ? limit / parts_ : limit};
}

}  // namespace tetskin::bullet_detail
