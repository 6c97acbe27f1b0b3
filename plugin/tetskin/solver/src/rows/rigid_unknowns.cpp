// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/rigid_unknowns.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// How far Bullet's velocities of kinematic bodies may be off: radians per step, and a fraction of the velocity.
constexpr btScalar kUnseenTurn = btScalar(1e-3), kUnseenShare = btScalar(1e-2);

/// The inverse mass matrix that btRigidBody::applyImpulse applies; symmetric unless factors lock single axes.
Eigen::MatrixXd inverseMassOf(const btRigidBody& rigid) {
  Eigen::MatrixXd inverse(6, 6);
  std::fill(inverse.data(), inverse.data() + inverse.size(), 0.0);
  const btVector3 &linear = rigid.getLinearFactor(), &angular = rigid.getAngularFactor();
  for (int i = 0; i < 3; ++i) {
    inverse(i, i) = static_cast<double>(rigid.getInvMass() * linear[i]);
    for (int j = 0; j < 3; ++j) {
      inverse(3 + i, 3 + j) = static_cast<double>(angular[i] * rigid.getInvInertiaTensorWorld()[i][j] * angular[j]);
    }
  }
  return inverse;
}

Eigen::MatrixXd inverseMassOf(btMultiBody& body) {
  const int size = 6 + body.getNumDofs();
  Eigen::MatrixXd inverse(size, size);
  btAlignedObjectArray<btScalar> force, answer, scratch;
  btAlignedObjectArray<btVector3> vectors;
  force.resize(size, 0);
  answer.resize(size, 0);
  for (int k = 0; k < size; ++k) {
    force[k] = 1;
    body.calcAccelerationDeltasMultiDof(&force[0], &answer[0], scratch, vectors);
    force[k] = 0;
    for (int i = 0; i < size; ++i) inverse(i, k) = static_cast<double>(answer[i]);
  }
  // It is symmetric up to rounding; now exactly.
  for (int k = 0; k < size; ++k) {
    for (int i = 0; i < k; ++i) inverse(i, k) = inverse(k, i) = 0.5 * (inverse(i, k) + inverse(k, i));
  }
  return inverse;
}

/// The difference between a turning point's path in a step and a straight path, per second.
btVector3 bend(const btVector3& turning, const btVector3& arm, btScalar seconds) {
  const btScalar rate = turning.length();
  if (!(rate * seconds > SIMD_EPSILON)) return {0, 0, 0};
  const SineAndCosine half = sineAndCosine(static_cast<double>(rate * seconds) / 2);
  const btVector3 part = turning * (static_cast<btScalar>(half.sine) / rate);
  const btQuaternion turn(part.x(), part.y(), part.z(), static_cast<btScalar>(half.cosine));
  const btVector3 turned = quatRotate(turn, arm);
  return (turned - arm) / seconds - turning.cross(arm);
}

const btMultiBodyLinkCollider* linkOf(const btCollisionObject& object) {
  return btMultiBodyLinkCollider::upcast(&object);
}

/// True if no contact changes the object's motion.
bool movesFreely(const btCollisionObject& object) {
  if (const btMultiBodyLinkCollider* link = linkOf(object)) return link->m_multiBody != nullptr;
  const btRigidBody* rigid = btRigidBody::upcast(&object);
  return rigid && !rigid->isStaticOrKinematicObject() && rigid->getInvMass() > 0;
}

}  // namespace

Small3x6 bodyJacobian(const RigidPoint& at) {
  const Small3x3 turning = -smallCrossMatrix(toSmall(at.arm));
  Small3x6 jacobian;
  for (int k = 0; k < 3; ++k) {
    jacobian(k, k) = 1.0;
    jacobian.setColumn(3 + k, turning.column(k));
  }
  return jacobian;
}

RigidUnknowns::Jacobian RigidUnknowns::toJacobian(const Small3x6& of) {
  Jacobian jacobian(3, 6);
  std::copy(of.values, of.values + of.kSize, jacobian.data());
  return jacobian;
}

void RigidUnknowns::clear() {
  unknowns_.clear();
  indices_.clear();
  jacobians_.clear();
}

const void* RigidUnknowns::keyOf(const btCollisionObject& object) {
  const btMultiBodyLinkCollider* link = linkOf(object);
  return link ? static_cast<const void*>(link->m_multiBody) : &object;
}

const void* RigidUnknowns::keyOf(const RigidUnknown& unknown) {
  return unknown.multiBody ? static_cast<const void*>(unknown.multiBody)
                           : static_cast<const btCollisionObject*>(unknown.rigid);
}

int RigidUnknowns::find(const btCollisionObject& object) const {
  const auto found = indices_.find(keyOf(object));
  return found == indices_.end() ? -1 : found->second;
}

int RigidUnknowns::addScalarJacobian(const btVector3& linear, const btVector3& angular) {
  Small3x6 jacobian;
  for (int k = 0; k < 3; ++k) {
    jacobian(0, k) = static_cast<double>(linear[k]);
    jacobian(0, 3 + k) = static_cast<double>(angular[k]);
  }
  jacobians_.push_back(toJacobian(jacobian));
  return static_cast<int>(jacobians_.size()) - 1;
}

int RigidUnknowns::add(const btCollisionObject& object) {
  const btMultiBodyLinkCollider* link = linkOf(object);
  const auto [found, isNew] = indices_.emplace(keyOf(object), static_cast<int>(unknowns_.size()));
  if (!isNew) return found->second;
  RigidUnknown& unknown = unknowns_.emplace_back();
  if (link) {
    unknown.multiBody = link->m_multiBody;
    unknown.size = 6 + link->m_multiBody->getNumDofs();
    unknown.inverseMass = inverseMassOf(*unknown.multiBody);
  } else {
    unknown.rigid = const_cast<btRigidBody*>(btRigidBody::upcast(&object));
    unknown.inverseMass = inverseMassOf(*unknown.rigid);
  }
  return found->second;
}

int RigidUnknowns::addLinkPoint(const btCollisionObject& object, const btVector3& position) {
  assert(linkOf(object) && linkOf(object)->m_multiBody);
  const btMultiBodyLinkCollider& link = *linkOf(object);
  const int size = 6 + link.m_multiBody->getNumDofs();
  Jacobian jacobian(3, size);
  btAlignedObjectArray<btScalar> row, scratch;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  row.resize(size, 0);
  for (int k = 0; k < 3; ++k) {
    btVector3 axis(0, 0, 0);
    axis[k] = 1;
    link.m_multiBody->fillContactJacobianMultiDof(link.m_link, position, axis, &row[0], scratch, vectors, matrices);
    for (int i = 0; i < size; ++i) jacobian(k, i) = static_cast<double>(row[i]);
  }
  jacobians_.push_back(std::move(jacobian));
  return static_cast<int>(jacobians_.size()) - 1;
}

RigidPoint RigidUnknowns::at(const btCollisionObject& object, const btVector3& position) {
  RigidPoint point;
  point.arm = position - startOf(object).getOrigin();
  if (!movesFreely(object)) return point;
  point.unknown = add(object);
  if (linkOf(object)) point.jacobian = addLinkPoint(object, position);
  return point;
}

btVector3 RigidUnknowns::velocityAt(const RigidPoint& at, const btCollisionObject& object, btScalar seconds) {
  if (linkOf(object) && at.jacobian >= 0) {
    const btMultiBody& body = *linkOf(object)->m_multiBody;
    const Jacobian& jacobian = jacobians_[static_cast<std::size_t>(at.jacobian)];
    Small3 sum;
    for (int k = 0; k < jacobian.cols(); ++k) {
      sum += smallFrom<3>(&jacobian(0, k)) * static_cast<double>(body.getVelocityVector()[k]);
    }
    btVector3 bent(0, 0, 0);
    if (seconds > 0) bent = bend(turningOf(object, unknowns_[static_cast<std::size_t>(at.unknown)]), at.arm, seconds);
    return fromSmall(sum) + bent;
  }
  const btRigidBody* rigid = btRigidBody::upcast(&object);
  if (!rigid) return {0, 0, 0};
  const btVector3 velocity =
      rigid->getVelocityInLocalPoint(at.arm) + bend(rigid->getAngularVelocity(), at.arm, seconds);
  return rigid->isKinematicObject() ? carriedBy(*rigid, at.arm, velocity, seconds) : velocity;
}

/// The angular velocity of a link before the solve, world space. Bullet computes those of all links at once.
btVector3 RigidUnknowns::turningOf(const btCollisionObject& link, RigidUnknown& unknown) {
  const btMultiBody& body = *unknown.multiBody;
  const int index = linkOf(link)->m_link;
  if (index < 0) return body.getBaseOmega();
  if (unknown.turning.empty()) {
    unknown.turning.resize(static_cast<std::size_t>(body.getNumLinks()) + 1);
    moving_.resize(unknown.turning.size());
    body.compTreeLinkVelocities(unknown.turning.data(), moving_.data());
  }
  return body.localDirToWorld(index, unknown.turning[static_cast<std::size_t>(index) + 1]);
}

/// Bullet computes the angular velocity of a kinematic body from the arc cosine of its rotation in a step, which leaves
/// few digits. Its transforms in this step and the last one have all of them.
btVector3 RigidUnknowns::carriedBy(const btRigidBody& body, const btVector3& arm, const btVector3& velocity,
                                   btScalar seconds) const {
  assert(body.isKinematicObject());
  const KinematicPath* path = paths_->find(body);
  if (!path || !path->isKnown) return velocity;
  const auto way = [&](const btTransform& to) {
    const btVector3 turned = to.getBasis() * (path->before.getBasis().transpose() * arm);
    return to.getOrigin() - path->before.getOrigin() + turned - arm;
  };
  const btVector3 carried = way(path->now()) / seconds;
  if (path->done > 1) return carried;
  // If the difference is larger, the body was put there, or it is a different body.
  const btScalar frame = static_cast<btScalar>(path->steps) * seconds;
  const btVector3 expected = body.getVelocityInLocalPoint(arm) + bend(body.getAngularVelocity(), arm, frame);
  const btScalar maximum = kUnseenTurn * arm.length() / frame + kUnseenShare * expected.length();
  return (way(path->to) / frame - expected).length() <= maximum ? carried : velocity;
}

bool RigidUnknowns::isLed(const btCollisionObject& object) const {
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (!body || !body->isKinematicObject()) return false;
  const KinematicPath* path = paths_->find(*body);
  return !path || path->done <= path->steps;
}

RigidUnknowns::Jacobian RigidUnknowns::jacobianOf(const RigidPoint& at) const {
  return at.jacobian >= 0 ? jacobians_[static_cast<std::size_t>(at.jacobian)] : toJacobian(bodyJacobian(at));
}

btVector3 RigidUnknowns::velocity(const RigidPoint& at, const Eigen::VectorXd& change) const {
  if (at.unknown < 0) return {0, 0, 0};
  const RigidUnknown& unknown = unknowns_[static_cast<std::size_t>(at.unknown)];
  if (at.jacobian >= 0) {
    const Jacobian& jacobian = jacobians_[static_cast<std::size_t>(at.jacobian)];
    Small3 sum;
    for (Eigen::Index k = 0; k < unknown.size; ++k) sum += smallFrom<3>(&jacobian(0, k)) * change[unknown.first + k];
    return fromSmall(sum);
  }
  const double* of = change.data() + unknown.first;
  return fromSmall(smallFrom<3>(of)) + fromSmall(smallFrom<3>(of + 3)).cross(at.arm);
}

void RigidUnknowns::addImpulse(const RigidPoint& at, const btVector3& impulse, Eigen::VectorXd& to) const {
  if (at.unknown < 0) return;
  const RigidUnknown& unknown = unknowns_[static_cast<std::size_t>(at.unknown)];
  if (at.jacobian >= 0) {
    const Jacobian& jacobian = jacobians_[static_cast<std::size_t>(at.jacobian)];
    for (Eigen::Index k = 0; k < unknown.size; ++k) {
      to[unknown.first + k] += dot(smallFrom<3>(&jacobian(0, k)), toSmall(impulse));
    }
    return;
  }
  const Small3 force = toSmall(impulse), torque = cross(toSmall(at.arm), force);
  for (int k = 0; k < 3; ++k) {
    to[unknown.first + k] += force[k];
    to[unknown.first + 3 + k] += torque[k];
  }
}

double RigidUnknowns::compliance(const RigidPoint& at, const btVector3& direction) const {
  if (at.unknown < 0) return 0.0;
  const RigidUnknown& unknown = unknowns_[static_cast<std::size_t>(at.unknown)];
  const Jacobian jacobian = jacobianOf(at);
  Eigen::VectorXd moment(jacobian.cols());
  for (Eigen::Index k = 0; k < moment.size(); ++k) moment[k] = dot(smallFrom<3>(&jacobian(0, k)), toSmall(direction));
  const Eigen::VectorXd answer = unknown.inverseMass * moment;
  double sum = 0.0;
  for (Eigen::Index k = 0; k < moment.size(); ++k) sum += moment[k] * answer[k];
  return sum;
}

void RigidUnknowns::push(const RigidPoint& at, const btVector3& impulse) const {
  if (at.unknown < 0) return;
  RigidUnknown alone = unknowns_[static_cast<std::size_t>(at.unknown)];
  alone.first = 0;
  const Jacobian jacobian = jacobianOf(at);
  Eigen::VectorXd given(jacobian.cols());
  for (Eigen::Index k = 0; k < given.size(); ++k) given[k] = dot(smallFrom<3>(&jacobian(0, k)), toSmall(impulse));
  apply(alone, alone.inverseMass * given);
}

void RigidUnknowns::apply(const RigidUnknown& unknown, const Eigen::VectorXd& change) {
  const double* part = change.data() + unknown.first;
  if (!std::all_of(part, part + unknown.size, [](double v) { return std::isfinite(v); })) return;
  if (unknown.rigid) {
    btRigidBody& rigid = *unknown.rigid;
    rigid.setLinearVelocity(rigid.getLinearVelocity() + fromSmall(smallFrom<3>(part)));
    rigid.setAngularVelocity(rigid.getAngularVelocity() + fromSmall(smallFrom<3>(part + 3)));
    return;
  }
  std::vector<btScalar> delta(static_cast<std::size_t>(unknown.size));
  for (Eigen::Index k = 0; k < unknown.size; ++k) delta[static_cast<std::size_t>(k)] = static_cast<btScalar>(part[k]);
  unknown.multiBody->applyDeltaVeeMultiDof(delta.data(), 1);
}

}  // namespace tetskin::bullet_detail
