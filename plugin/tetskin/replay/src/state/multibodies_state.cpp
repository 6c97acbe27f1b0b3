// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/world_state.h>

namespace tetskin::bullet_detail {

/// A cache that Bullet keeps between steps; the body determines its length.
template <class T>
void serialize(WorldStream& stream, btAlignedObjectArray<T>& cache) {
  if (stream.length(static_cast<std::size_t>(cache.size())) != static_cast<std::size_t>(cache.size())) {
    return stream.fail();
  }
  if constexpr (std::is_arithmetic_v<T>) {
    if (cache.size() > 0) stream.plain(&cache[0], static_cast<std::size_t>(cache.size()));
  } else {
    for (int k = 0; k < cache.size(); ++k) stream(cache[k]);
  }
}

void serialize(WorldStream& stream, btSpatialMotionVector& vector) {
  serializeAll(stream, vector.m_topVec, vector.m_bottomVec);
}

using AnyMultiBody = btMultiBody;
template struct Serialized<
    AnyMultiBody, &AnyMultiBody::m_basePos, &AnyMultiBody::m_basePos_interpolate, &AnyMultiBody::m_baseQuat,
    &AnyMultiBody::m_baseQuat_interpolate, &AnyMultiBody::m_baseMass, &AnyMultiBody::m_baseInertia,
    &AnyMultiBody::m_baseForce, &AnyMultiBody::m_baseTorque, &AnyMultiBody::m_baseConstraintForce,
    &AnyMultiBody::m_baseConstraintTorque, &AnyMultiBody::m_splitV, &AnyMultiBody::m_deltaV, &AnyMultiBody::m_realBuf,
    &AnyMultiBody::m_vectorBuf, &AnyMultiBody::m_matrixBuf, &AnyMultiBody::m_cachedInertiaTopLeft,
    &AnyMultiBody::m_cachedInertiaTopRight, &AnyMultiBody::m_cachedInertiaLowerLeft,
    &AnyMultiBody::m_cachedInertiaLowerRight, &AnyMultiBody::m_cachedInertiaValid, &AnyMultiBody::m_fixedBase,
    &AnyMultiBody::m_awake, &AnyMultiBody::m_canSleep, &AnyMultiBody::m_canWakeup, &AnyMultiBody::m_sleepTimer,
    &AnyMultiBody::m_sleepEpsilon, &AnyMultiBody::m_sleepTimeout, &AnyMultiBody::m_companionId,
    &AnyMultiBody::m_linearDamping, &AnyMultiBody::m_angularDamping, &AnyMultiBody::m_useGyroTerm,
    &AnyMultiBody::m_maxAppliedImpulse, &AnyMultiBody::m_maxCoordinateVelocity, &AnyMultiBody::m_hasSelfCollision,
    &AnyMultiBody::__posUpdated, &AnyMultiBody::m_useRK4, &AnyMultiBody::m_useGlobalVelocities,
    &AnyMultiBody::m_internalNeedsJointFeedback, &AnyMultiBody::m_kinematic_calculate_velocity>;

namespace {

void serializeLink(WorldStream& stream, btMultibodyLink& l) {
  serializeAll(stream, l.m_mass, l.m_inertiaLocal, l.m_zeroRotParentToThis, l.m_dVector, l.m_eVector,
               l.m_absFrameTotVelocity, l.m_absFrameLocVelocity, l.m_axes, l.m_cachedRotParentToThis, l.m_cachedRVector,
               l.m_cachedRotParentToThis_interpolate, l.m_cachedRVector_interpolate, l.m_appliedForce,
               l.m_appliedTorque, l.m_appliedConstraintForce, l.m_appliedConstraintTorque, l.m_jointPos,
               l.m_jointPos_interpolate, l.m_jointTorque, l.m_flags, l.m_cachedWorldTransform, l.m_jointDamping,
               l.m_jointFriction, l.m_jointLowerLimit, l.m_jointUpperLimit, l.m_jointMaxForce, l.m_jointMaxVelocity);
  bool measured = l.m_jointFeedback;
  stream(measured);
  if (!measured) return;
  btMultiBodyJointFeedback none;
  btMultiBodyJointFeedback& feedback = l.m_jointFeedback ? *l.m_jointFeedback : none;
  btSpatialForceVector& forces = feedback.m_reactionForces;
  serializeAll(stream, forces.m_topVec, forces.m_bottomVec);
}

}  // namespace

void serializeMultiBodies(WorldStream& stream) {
  btDeformableMultiBodyDynamicsWorld& world = stream.world();
  for (int k = 0; k < world.getNumMultibodies(); ++k) {
    btMultiBody& body = *world.getMultiBody(k);
    serializeMembers(stream, body);
    for (int link = 0; link < body.getNumLinks(); ++link) serializeLink(stream, body.getLink(link));
  }
}

}  // namespace tetskin::bullet_detail
