// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Settings of joints, which the application may change at any time, and what Bullet remembers of them from step to
// step. What a joint recomputes from its bodies in each step is not saved: its Jacobians, frames in the world, axes.
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/world_state.h>

#include <cassert>
#include <memory>

namespace tetskin::bullet_detail {

void serialize(WorldStream& stream, btAngularLimit& limit);
void serialize(WorldStream& stream, btConstraintSetting& s) {
  serializeAll(stream, s.m_tau, s.m_damping, s.m_impulseClamp);
}
void serialize(WorldStream& stream, btRotationalLimitMotor& m) {
  serializeAll(stream, m.m_loLimit, m.m_hiLimit, m.m_targetVelocity, m.m_maxMotorForce, m.m_maxLimitForce, m.m_damping,
               m.m_limitSoftness, m.m_normalCFM, m.m_stopERP, m.m_stopCFM, m.m_bounce, m.m_enableMotor,
               m.m_currentLimitError, m.m_currentPosition, m.m_currentLimit, m.m_accumulatedImpulse);
}
void serialize(WorldStream& stream, btTranslationalLimitMotor& m) {
  serializeAll(stream, m.m_lowerLimit, m.m_upperLimit, m.m_accumulatedImpulse, m.m_limitSoftness, m.m_damping,
               m.m_restitution, m.m_normalCFM, m.m_stopERP, m.m_stopCFM, m.m_enableMotor, m.m_targetVelocity,
               m.m_maxMotorForce, m.m_currentLimitError, m.m_currentLinearDiff, m.m_currentLimit);
}
void serialize(WorldStream& stream, btRotationalLimitMotor2& m) {
  serializeAll(stream, m.m_loLimit, m.m_hiLimit, m.m_bounce, m.m_stopERP, m.m_stopCFM, m.m_motorERP, m.m_motorCFM,
               m.m_enableMotor, m.m_targetVelocity, m.m_maxMotorForce, m.m_servoMotor, m.m_servoTarget,
               m.m_enableSpring, m.m_springStiffness, m.m_springStiffnessLimited, m.m_springDamping,
               m.m_springDampingLimited, m.m_equilibriumPoint, m.m_currentLimitError, m.m_currentLimitErrorHi,
               m.m_currentPosition, m.m_currentLimit);
}
void serialize(WorldStream& stream, btTranslationalLimitMotor2& m) {
  serializeAll(stream, m.m_lowerLimit, m.m_upperLimit, m.m_bounce, m.m_stopERP, m.m_stopCFM, m.m_motorERP, m.m_motorCFM,
               m.m_enableMotor, m.m_servoMotor, m.m_enableSpring, m.m_servoTarget, m.m_springStiffness,
               m.m_springStiffnessLimited, m.m_springDamping, m.m_springDampingLimited, m.m_equilibriumPoint,
               m.m_targetVelocity, m.m_maxMotorForce, m.m_currentLimitError, m.m_currentLimitErrorHi,
               m.m_currentLinearDiff, m.m_currentLimit);
}

using AnyJoint = btTypedConstraint;
template struct Serialized<AnyJoint, &AnyJoint::m_isEnabled, &AnyJoint::m_breakingImpulseThreshold,
                           &AnyJoint::m_needsFeedback, &AnyJoint::m_overrideNumSolverIterations,
                           &AnyJoint::m_appliedImpulse>;

using AngularLimit = btAngularLimit;
template struct Serialized<AngularLimit, &AngularLimit::m_center, &AngularLimit::m_halfRange, &AngularLimit::m_softness,
                           &AngularLimit::m_biasFactor, &AngularLimit::m_relaxationFactor>;
void serialize(WorldStream& stream, btAngularLimit& limit) {
  serializeMembers(stream, limit);
}

using BallJoint = btPoint2PointConstraint;
template struct Serialized<BallJoint, &BallJoint::m_pivotInA, &BallJoint::m_pivotInB, &BallJoint::m_flags,
                           &BallJoint::m_erp, &BallJoint::m_cfm, &BallJoint::m_setting,
                           &BallJoint::m_useSolveConstraintObsolete>;

using HingeJoint = btHingeConstraint;
template struct Serialized<HingeJoint, &HingeJoint::m_rbAFrame, &HingeJoint::m_rbBFrame,
                           &HingeJoint::m_motorTargetVelocity, &HingeJoint::m_maxMotorImpulse,
#ifdef _BT_USE_CENTER_LIMIT_
                           &HingeJoint::m_limit,
#else
                           &HingeJoint::m_lowerLimit, &HingeJoint::m_upperLimit, &HingeJoint::m_limitSoftness,
                           &HingeJoint::m_biasFactor, &HingeJoint::m_relaxationFactor,
#endif
                           &HingeJoint::m_referenceSign, &HingeJoint::m_angularOnly, &HingeJoint::m_enableAngularMotor,
                           &HingeJoint::m_useSolveConstraintObsolete, &HingeJoint::m_useOffsetForConstraintFrame,
                           &HingeJoint::m_useReferenceFrameA, &HingeJoint::m_flags, &HingeJoint::m_normalCFM,
                           &HingeJoint::m_normalERP, &HingeJoint::m_stopCFM, &HingeJoint::m_stopERP>;

template struct Serialized<btHingeAccumulatedAngleConstraint, &btHingeAccumulatedAngleConstraint::m_accumulatedAngle>;

using ConeJoint = btConeTwistConstraint;
template struct Serialized<
    ConeJoint, &ConeJoint::m_rbAFrame, &ConeJoint::m_rbBFrame, &ConeJoint::m_limitSoftness, &ConeJoint::m_biasFactor,
    &ConeJoint::m_relaxationFactor, &ConeJoint::m_damping, &ConeJoint::m_swingSpan1, &ConeJoint::m_swingSpan2,
    &ConeJoint::m_twistSpan, &ConeJoint::m_fixThresh, &ConeJoint::m_twistAngle, &ConeJoint::m_angularOnly,
    &ConeJoint::m_useSolveConstraintObsolete, &ConeJoint::m_bMotorEnabled, &ConeJoint::m_bNormalizedMotorStrength,
    &ConeJoint::m_qTarget, &ConeJoint::m_maxMotorImpulse, &ConeJoint::m_accMotorImpulse, &ConeJoint::m_flags,
    &ConeJoint::m_linCFM, &ConeJoint::m_linERP, &ConeJoint::m_angCFM>;

using SliderJoint = btSliderConstraint;
template struct Serialized<
    SliderJoint, &SliderJoint::m_useSolveConstraintObsolete, &SliderJoint::m_useOffsetForConstraintFrame,
    &SliderJoint::m_frameInA, &SliderJoint::m_frameInB, &SliderJoint::m_useLinearReferenceFrameA,
    &SliderJoint::m_lowerLinLimit, &SliderJoint::m_upperLinLimit, &SliderJoint::m_lowerAngLimit,
    &SliderJoint::m_upperAngLimit, &SliderJoint::m_softnessDirLin, &SliderJoint::m_restitutionDirLin,
    &SliderJoint::m_dampingDirLin, &SliderJoint::m_cfmDirLin, &SliderJoint::m_softnessDirAng,
    &SliderJoint::m_restitutionDirAng, &SliderJoint::m_dampingDirAng, &SliderJoint::m_cfmDirAng,
    &SliderJoint::m_softnessLimLin, &SliderJoint::m_restitutionLimLin, &SliderJoint::m_dampingLimLin,
    &SliderJoint::m_cfmLimLin, &SliderJoint::m_softnessLimAng, &SliderJoint::m_restitutionLimAng,
    &SliderJoint::m_dampingLimAng, &SliderJoint::m_cfmLimAng, &SliderJoint::m_softnessOrthoLin,
    &SliderJoint::m_restitutionOrthoLin, &SliderJoint::m_dampingOrthoLin, &SliderJoint::m_cfmOrthoLin,
    &SliderJoint::m_softnessOrthoAng, &SliderJoint::m_restitutionOrthoAng, &SliderJoint::m_dampingOrthoAng,
    &SliderJoint::m_cfmOrthoAng, &SliderJoint::m_flags, &SliderJoint::m_poweredLinMotor,
    &SliderJoint::m_targetLinMotorVelocity, &SliderJoint::m_maxLinMotorForce,
    &SliderJoint::m_accumulatedLinMotorImpulse, &SliderJoint::m_poweredAngMotor, &SliderJoint::m_targetAngMotorVelocity,
    &SliderJoint::m_maxAngMotorForce, &SliderJoint::m_accumulatedAngMotorImpulse>;

using SixDofJoint = btGeneric6DofConstraint;
template struct Serialized<SixDofJoint, &SixDofJoint::m_frameInA, &SixDofJoint::m_frameInB,
                           &SixDofJoint::m_linearLimits, &SixDofJoint::m_angularLimits,
                           &SixDofJoint::m_useLinearReferenceFrameA, &SixDofJoint::m_useOffsetForConstraintFrame,
                           &SixDofJoint::m_flags>;

using SpringJoint = btGeneric6DofSpringConstraint;
template struct Serialized<SpringJoint, &SpringJoint::m_springEnabled, &SpringJoint::m_equilibriumPoint,
                           &SpringJoint::m_springStiffness, &SpringJoint::m_springDamping>;

using SpringJoint2 = btGeneric6DofSpring2Constraint;
template struct Serialized<SpringJoint2, &SpringJoint2::m_frameInA, &SpringJoint2::m_frameInB,
                           &SpringJoint2::m_linearLimits, &SpringJoint2::m_angularLimits, &SpringJoint2::m_rotateOrder,
                           &SpringJoint2::m_flags>;

using GearJoint = btGearConstraint;
template struct Serialized<GearJoint, &GearJoint::m_axisInA, &GearJoint::m_axisInB, &GearJoint::m_useFrameA,
                           &GearJoint::m_ratio>;

using BodyJoint = btMultiBodyConstraint;
template struct Serialized<BodyJoint, &BodyJoint::m_maxAppliedImpulse, &BodyJoint::m_isUnilateral>;
/// Its data begin with the impulses with which the next step starts; Jacobians, recomputed in each step, follow.
using JointData = Hidden<BodyJoint, btAlignedObjectArray<btScalar>>;
template struct Opened<JointData, &BodyJoint::m_data>;

using LinkMotor = btMultiBodyJointMotor;
template struct Serialized<LinkMotor, &LinkMotor::m_desiredVelocity, &LinkMotor::m_desiredPosition, &LinkMotor::m_kd,
                           &LinkMotor::m_kp, &LinkMotor::m_erp, &LinkMotor::m_rhsClamp>;
template struct Serialized<btMultiBodyJointLimitConstraint, &btMultiBodyJointLimitConstraint::m_lowerBound,
                           &btMultiBodyJointLimitConstraint::m_upperBound>;
using LinkWeld = btMultiBodyFixedConstraint;
template struct Serialized<LinkWeld, &LinkWeld::m_pivotInA, &LinkWeld::m_pivotInB, &LinkWeld::m_frameInA,
                           &LinkWeld::m_frameInB>;
template struct Serialized<btMultiBodyPoint2Point, &btMultiBodyPoint2Point::m_pivotInA,
                           &btMultiBodyPoint2Point::m_pivotInB>;
using LinkSlider = btMultiBodySliderConstraint;
template struct Serialized<LinkSlider, &LinkSlider::m_pivotInA, &LinkSlider::m_pivotInB, &LinkSlider::m_frameInA,
                           &LinkSlider::m_frameInB, &LinkSlider::m_jointAxis>;
using LinkGear = btMultiBodyGearConstraint;
template struct Serialized<LinkGear, &LinkGear::m_pivotInA, &LinkGear::m_pivotInB, &LinkGear::m_frameInA,
                           &LinkGear::m_frameInB, &LinkGear::m_gearRatio, &LinkGear::m_gearAuxLink, &LinkGear::m_erp,
                           &LinkGear::m_relativePositionTarget>;
using BallMotor = btMultiBodySphericalJointMotor;
template struct Serialized<BallMotor, &BallMotor::m_desiredVelocity, &BallMotor::m_desiredPosition,
                           &BallMotor::m_use_multi_dof_params, &BallMotor::m_kd, &BallMotor::m_kp, &BallMotor::m_erp,
                           &BallMotor::m_rhsClamp, &BallMotor::m_maxAppliedImpulseMultiDof, &BallMotor::m_damping>;
using BallLimit = btMultiBodySphericalJointLimit;
template struct Serialized<BallLimit, &BallLimit::m_desiredVelocity, &BallLimit::m_desiredPosition,
                           &BallLimit::m_use_multi_dof_params, &BallLimit::m_kd, &BallLimit::m_kp, &BallLimit::m_erp,
                           &BallLimit::m_rhsClamp, &BallLimit::m_maxAppliedImpulseMultiDof, &BallLimit::m_pivotA,
                           &BallLimit::m_pivotB, &BallLimit::m_swingxRange, &BallLimit::m_swingyRange,
                           &BallLimit::m_twistRange>;

namespace {

/// The member functions for this class and its bases.
template <class Joint, class... Bases>
void serializeAs(WorldStream& stream, btTypedConstraint& joint) {
  (serializeMembers(stream, static_cast<Bases&>(static_cast<Joint&>(joint))), ...);
}
template <class Joint>
void serializeAs(WorldStream& stream, btMultiBodyConstraint& joint) {
  serializeMembers(stream, static_cast<Joint&>(joint));
}

/// One of Bullet's classes, represented by an object of it.
template <class Base>
struct JointClass {
  std::unique_ptr<Base> sample;
  void (*visit)(WorldStream&, Base&);
};
template <class Classes, class Base>
const typename Classes::value_type* classOf(const Classes& classes, const Base& joint) {
  for (const auto& known : classes) {
    if (isOfSameClass(joint, *known.sample)) return &known;
  }
  return nullptr;
}

using JointClasses = std::vector<JointClass<btTypedConstraint>>;

const JointClasses& jointClasses() {
  static const JointClasses* const classes = [] {
    auto& body = *new btRigidBody(1, nullptr, nullptr);
    const btTransform frame = btTransform::getIdentity();
    btVector3 origin(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
    auto* all = new JointClasses;
    const auto add = [all](btTypedConstraint* sample, void (*visit)(WorldStream&, btTypedConstraint&)) {
      all->push_back({std::unique_ptr<btTypedConstraint>(sample), visit});
    };
    add(new BallJoint(body, body, origin, origin), serializeAs<BallJoint, BallJoint>);
    add(new HingeJoint(body, body, frame, frame), serializeAs<HingeJoint, HingeJoint>);
    using Turns = btHingeAccumulatedAngleConstraint;
    add(new Turns(body, body, frame, frame), serializeAs<Turns, HingeJoint, Turns>);
    add(new ConeJoint(body, body, frame, frame), serializeAs<ConeJoint, ConeJoint>);
    add(new SliderJoint(body, body, frame, frame, false), serializeAs<SliderJoint, SliderJoint>);
    add(new SixDofJoint(body, body, frame, frame, false), serializeAs<SixDofJoint, SixDofJoint>);
    add(new btUniversalConstraint(body, body, origin, x, y), serializeAs<btUniversalConstraint, SixDofJoint>);
    add(new SpringJoint(body, body, frame, frame, false), serializeAs<SpringJoint, SixDofJoint, SpringJoint>);
    add(new SpringJoint2(body, body, frame, frame), serializeAs<SpringJoint2, SpringJoint2>);
    add(new btHinge2Constraint(body, body, origin, x, y), serializeAs<btHinge2Constraint, SpringJoint2>);
    add(new btFixedConstraint(body, body, frame, frame), serializeAs<btFixedConstraint, SpringJoint2>);
    add(new GearJoint(body, body, x, y), serializeAs<GearJoint, GearJoint>);
    return all;
  }();
  return *classes;
}

using BodyJointClasses = std::vector<JointClass<btMultiBodyConstraint>>;

const BodyJointClasses& bodyJointClasses() {
  static const BodyJointClasses* const classes = [] {
    auto& body = *new btMultiBody(1, 1, btVector3(1, 1, 1), true, false);
    const btVector3 origin(0, 0, 0), x(1, 0, 0);
    const btMatrix3x3 frame = btMatrix3x3::getIdentity();
    body.setupSpherical(0, 1, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(), origin, origin);
    body.finalizeMultiDof();
    auto* all = new BodyJointClasses;
    const auto add = [all](btMultiBodyConstraint* sample, void (*visit)(WorldStream&, btMultiBodyConstraint&)) {
      all->push_back({std::unique_ptr<btMultiBodyConstraint>(sample), visit});
    };
    add(new LinkMotor(&body, 0, 0, 0), serializeAs<LinkMotor>);
    add(new btMultiBodyJointLimitConstraint(&body, 0, 0, 0), serializeAs<btMultiBodyJointLimitConstraint>);
    add(new LinkWeld(&body, 0, &body, -1, origin, origin, frame, frame), serializeAs<LinkWeld>);
    add(new btMultiBodyPoint2Point(&body, 0, &body, -1, origin, origin), serializeAs<btMultiBodyPoint2Point>);
    add(new LinkSlider(&body, 0, &body, -1, origin, origin, frame, frame, x), serializeAs<LinkSlider>);
    add(new LinkGear(&body, 0, &body, -1, origin, origin, frame, frame), serializeAs<LinkGear>);
    add(new BallMotor(&body, 0, 0), serializeAs<BallMotor>);
    add(new BallLimit(&body, 0, 0, 0, 0, 0), serializeAs<BallLimit>);
    return all;
  }();
  return *classes;
}

void serializeFeedback(WorldStream& stream, btTypedConstraint& joint) {
  bool measured = joint.getJointFeedback();
  stream(measured);
  if (!measured) return;
  btJointFeedback none;
  btJointFeedback& f = joint.getJointFeedback() ? *joint.getJointFeedback() : none;
  serializeAll(stream, f.m_appliedForceBodyA, f.m_appliedTorqueBodyA, f.m_appliedForceBodyB, f.m_appliedTorqueBodyB);
}

/// A joint has no memory for its impulses before its first step.
void serializeImpulses(WorldStream& stream, btMultiBodyConstraint& joint) {
  auto& data = joint.*memberOf(JointData());
  for (int row = 0; row < joint.getNumRows(); ++row) {
    btScalar impulse = row < data.size() ? data[row] : 0;
    stream(impulse);
    if (!stream.restoring()) continue;
    if (impulse != 0 && row >= data.size()) joint.finalizeMultiDof();
    if (row < data.size()) data[row] = impulse;
  }
}

}  // namespace

bool isSaved(const btTypedConstraint& joint) {
  return classOf(jointClasses(), joint);
}
bool isSaved(const btMultiBodyConstraint& joint) {
  return classOf(bodyJointClasses(), joint);
}

int classOfJoint(const btTypedConstraint& joint) {
  const auto* found = classOf(jointClasses(), joint);
  assert(found);
  return static_cast<int>(found - jointClasses().data());
}

void serializeJoints(WorldStream& stream) {
  btDeformableMultiBodyDynamicsWorld& world = stream.world();
  for (int k = 0; k < world.getNumConstraints(); ++k) {
    btTypedConstraint& joint = *world.getConstraint(k);
    serializeMembers(stream, joint);
    serializeFeedback(stream, joint);
    classOf(jointClasses(), joint)->visit(stream, joint);
  }
  for (int k = 0; k < world.getNumMultiBodyConstraints(); ++k) {
    btMultiBodyConstraint& joint = *world.getMultiBodyConstraint(k);
    serializeMembers(stream, joint);
    serializeImpulses(stream, joint);
    classOf(bodyJointClasses(), joint)->visit(stream, joint);
  }
}

}  // namespace tetskin::bullet_detail
