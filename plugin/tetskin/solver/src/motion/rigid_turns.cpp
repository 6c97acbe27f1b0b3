// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btTransformUtil.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/solver/src/motion/rigid_turns.h>

#include <cassert>

namespace tetskin::bullet_detail {

/// Bullet's operations in Bullet's order: the same bits, if the C library rounds sine and cosine correctly.
btMatrix3x3 turned(const btTransform& from, const btVector3& velocity, btScalar seconds) {
  const btScalar squared = velocity.length2();
  btScalar speed = squared > SIMD_EPSILON ? btSqrt(squared) : btScalar(0);
  if (speed * seconds > ANGULAR_MOTION_THRESHOLD) speed = ANGULAR_MOTION_THRESHOLD / seconds;
  const SineAndCosine half = sineAndCosine(static_cast<double>(btScalar(0.5) * speed * seconds));
  constexpr auto kSlow = btScalar(0.001);  // below, a series replaces the sine
  const btScalar part =
      speed < kSlow ? btScalar(0.5) * seconds - seconds * seconds * seconds * btScalar(0.020833333333) * speed * speed
                    : static_cast<btScalar>(half.sine) / speed;
  const btVector3 axis = velocity * part;
  const btQuaternion turn(axis.x(), axis.y(), axis.z(), static_cast<btScalar>(half.cosine));
  btQuaternion result = turn * from.getRotation();
  result.safeNormalize();
  return result.length2() > SIMD_EPSILON ? btMatrix3x3(result) : from.getBasis();
}

void RigidTurns::predict(const Bodies& bodies, btScalar seconds) {
  for (int i = 0; i < bodies.size(); ++i) {
    btRigidBody& body = *bodies[i];
    if (body.isStaticOrKinematicObject()) continue;
    body.getInterpolationWorldTransform().setBasis(
        turned(body.getWorldTransform(), body.getAngularVelocity(), seconds));
  }
}

void RigidTurns::begin(const Bodies& bodies) {
  before_.clear();
  for (int i = 0; i < bodies.size(); ++i) {
    before_.push_back({bodies[i]->getWorldTransform(), bodies[i]->getAngularVelocity()});
  }
}

void RigidTurns::end(const Bodies& bodies, btScalar seconds) const {
  assert(static_cast<std::size_t>(bodies.size()) == before_.size());
  for (int i = 0; i < bodies.size(); ++i) {
    btRigidBody& body = *bodies[i];
    if (!body.isActive() || body.isStaticOrKinematicObject() || body.getHitFraction() < 1) continue;
    const Before& before = before_[static_cast<std::size_t>(i)];
    const btMatrix3x3 rotation = turned(before.transform, before.velocity, seconds);
    body.proceedToTransform(btTransform(rotation, body.getWorldTransform().getOrigin()));
  }
}

}  // namespace tetskin::bullet_detail
