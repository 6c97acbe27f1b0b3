// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/world_state.h>

namespace tetskin::bullet_detail {

template struct Serialized<
    btCollisionObject, &btCollisionObject::m_worldTransform, &btCollisionObject::m_interpolationWorldTransform,
    &btCollisionObject::m_interpolationLinearVelocity, &btCollisionObject::m_interpolationAngularVelocity,
    &btCollisionObject::m_anisotropicFriction, &btCollisionObject::m_hasAnisotropicFriction,
    &btCollisionObject::m_contactProcessingThreshold, &btCollisionObject::m_collisionFlags,
    &btCollisionObject::m_islandTag1, &btCollisionObject::m_companionId, &btCollisionObject::m_activationState1,
    &btCollisionObject::m_deactivationTime, &btCollisionObject::m_friction, &btCollisionObject::m_restitution,
    &btCollisionObject::m_rollingFriction, &btCollisionObject::m_spinningFriction, &btCollisionObject::m_contactDamping,
    &btCollisionObject::m_contactStiffness, &btCollisionObject::m_hitFraction,
    &btCollisionObject::m_ccdSweptSphereRadius, &btCollisionObject::m_ccdMotionThreshold,
    &btCollisionObject::m_checkCollideWith, &btCollisionObject::m_updateRevision>;

/// Objects that it ignores, set by `setIgnoreCollisionCheck`: `m_checkCollideWith` counts them.
using PassesThrough = Hidden<btCollisionObject, btAlignedObjectArray<const btCollisionObject*>>;
template struct Opened<PassesThrough, &btCollisionObject::m_objectsWithoutCollisionCheck>;

template struct Serialized<
    btRigidBody, &btRigidBody::m_linearVelocity, &btRigidBody::m_angularVelocity, &btRigidBody::m_inverseMass,
    &btRigidBody::m_linearFactor, &btRigidBody::m_gravity, &btRigidBody::m_gravity_acceleration,
    &btRigidBody::m_invInertiaLocal, &btRigidBody::m_invInertiaTensorWorld, &btRigidBody::m_totalForce,
    &btRigidBody::m_totalTorque, &btRigidBody::m_linearDamping, &btRigidBody::m_angularDamping,
    &btRigidBody::m_additionalDamping, &btRigidBody::m_additionalDampingFactor,
    &btRigidBody::m_additionalLinearDampingThresholdSqr, &btRigidBody::m_additionalAngularDampingThresholdSqr,
    &btRigidBody::m_additionalAngularDampingFactor, &btRigidBody::m_linearSleepingThreshold,
    &btRigidBody::m_angularSleepingThreshold, &btRigidBody::m_rigidbodyFlags, &btRigidBody::m_deltaLinearVelocity,
    &btRigidBody::m_deltaAngularVelocity, &btRigidBody::m_angularFactor, &btRigidBody::m_invMass,
    &btRigidBody::m_pushVelocity, &btRigidBody::m_turnVelocity>;

/// The world's clock and settings.
using World = btDeformableMultiBodyDynamicsWorld;
template struct Serialized<World, &World::m_localTime, &World::m_fixedTimeStep, &World::m_internalTime,
                           &World::m_gravity, &World::m_synchronizeAllMotionStates,
                           &World::m_latencyMotionStateInterpolation, &World::m_applySpeculativeContactRestitution,
                           &World::m_forceUpdateAllAabbs, &World::m_ccdIterations, &World::m_implicit,
                           &World::m_lineSearch, &World::m_useProjection>;

namespace {

/// Some may be in no world, or no longer exist: their pointers are only compared, and kept as they are.
void serializeIgnored(WorldStream& stream, btCollisionObject& object) {
  auto& ignored = object.*memberOf(PassesThrough());
  const btCollisionObjectArray& objects = stream.world().getCollisionObjectArray();
  std::vector<int> indices;
  for (int k = 0; k < ignored.size(); ++k) {
    const int index = objects.findLinearSearch(const_cast<btCollisionObject*>(ignored[k]));  // NOLINT: of pointers
    if (index < objects.size()) indices.push_back(index);
  }
  if (stream.restoring()) {
    for (const int index : indices) ignored.remove(objects[index]);
  }
  stream.array(indices);
  if (!stream.restoring()) return;
  for (const int index : indices) {
    if (index < 0 || index >= objects.size()) return stream.fail();
    ignored.push_back(objects[index]);
  }
}

void serializeSettings(WorldStream& stream, btContactSolverInfoData& s) {
  serializeAll(stream, s.m_tau, s.m_damping, s.m_friction, s.m_timeStep, s.m_restitution, s.m_numIterations,
               s.m_maxErrorReduction, s.m_sor, s.m_erp, s.m_erp2, s.m_deformable_erp, s.m_deformable_cfm,
               s.m_deformable_maxErrorReduction, s.m_globalCfm, s.m_frictionERP, s.m_frictionCFM, s.m_splitImpulse,
               s.m_splitImpulsePenetrationThreshold, s.m_splitImpulseTurnErp, s.m_linearSlop, s.m_warmstartingFactor,
               s.m_articulatedWarmstartingFactor, s.m_solverMode, s.m_restingContactRestitutionThreshold,
               s.m_minimumSolverBatchSize, s.m_maxGyroscopicForce, s.m_singleAxisRollingFrictionThreshold,
               s.m_leastSquaresResidualThreshold, s.m_restitutionVelocityThreshold, s.m_jointFeedbackInWorldSpace,
               s.m_jointFeedbackInJointFrame, s.m_reportSolverAnalytics, s.m_numNonContactInnerIterations);
}

void serializeSettings(WorldStream& stream, btDispatcherInfo& s) {
  serializeAll(stream, s.m_timeStep, s.m_stepCount, s.m_dispatchFunc, s.m_timeOfImpact, s.m_useContinuous,
               s.m_enableSatConvex, s.m_enableSPU, s.m_useEpa, s.m_allowedCcdPenetration,
               s.m_useConvexConservativeDistanceUtil, s.m_convexConservativeDistanceThreshold,
               s.m_deterministicOverlappingPairs);
}

void serializeClock(WorldStream& stream) {
  World& world = stream.world();
  serializeMembers(stream, world);
  serializeSettings(stream, world.getSolverInfo());
  serializeSettings(stream, world.getDispatchInfo());
  // The solver takes rows in random order, if the application wants that.
  auto& solver = static_cast<btSequentialImpulseConstraintSolver&>(*world.getConstraintSolver());
  unsigned long seed = solver.getRandSeed();
  auto word = static_cast<std::uint64_t>(seed);
  stream(word);
  if (stream.restoring()) solver.setRandSeed(static_cast<unsigned long>(word));
}

}  // namespace

void serializeObjects(WorldStream& stream) {
  World& world = stream.world();
  serializeClock(stream);
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    serializeMembers(stream, *objects[k]);
    serializeIgnored(stream, *objects[k]);
    if (btRigidBody* body = btRigidBody::upcast(objects[k])) serializeMembers(stream, *body);
  }
  serializeMultiBodies(stream);
  if (!stream.restoring()) return;
  for (int k = 0; k < objects.size(); ++k) {
    btRigidBody* body = btRigidBody::upcast(objects[k]);
    if (body) world.synchronizeSingleMotionState(body);  // including sleeping ones
  }
}

}  // namespace tetskin::bullet_detail
