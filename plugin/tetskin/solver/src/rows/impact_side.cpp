// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/core/src/base/cross_matrix.h>
#include <tetskin/solver/src/rows/impact_side.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

std::array<double, 3> tripleOf(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

btVector3 vectorOf(const double* v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

}  // namespace

bool ImpactSide::moves() const {
  if (soft_) return true;
  if (const auto* link = btMultiBodyLinkCollider::upcast(&object_)) return link->m_multiBody != nullptr;
  const btRigidBody* rigid = btRigidBody::upcast(&object_);
  return rigid && !rigid->isStaticOrKinematicObject() && rigid->getInvMass() > 0;
}

btScalar ImpactSide::mass() const {
  assert(moves());
  if (soft_) return static_cast<btScalar>(soft_->dynamics->componentMass(component_));
  const btRigidBody* rigid = btRigidBody::upcast(&object_);
  if (rigid) return 1 / rigid->getInvMass();
  btScalar sum = 0;
  const btMultiBody& body = *btMultiBodyLinkCollider::upcast(&object_)->m_multiBody;
  sum += body.getBaseMass();
  for (int k = 0; k < body.getNumLinks(); ++k) sum += body.getLinkMass(k);
  return sum;
}

btVector3 ImpactSide::centre() const {
  if (soft_) return vectorOf(soft_->dynamics->centreOf(component_).data());
  const btRigidBody* rigid = btRigidBody::upcast(&object_);
  return rigid ? rigid->getCenterOfMassPosition() : object_.getWorldTransform().getOrigin();
}

SideMotion ImpactSide::motion(const btVector3& at, bool solved) const {
  SideMotion motion;
  if (soft_) {
    const elastic_detail::RigidVelocity own = soft_->dynamics->rigidVelocity(component_, solved);
    motion.linear = vectorOf(own.velocity);
    for (int k = 0; k < 3; ++k) motion.field[k] = vectorOf(own.field + 3 * k);
    return motion;
  }
  if (const btRigidBody* rigid = btRigidBody::upcast(&object_)) {
    motion.linear = rigid->getLinearVelocity();
    rigid->getAngularVelocity().getSkewSymmetricMatrix(&motion.field[0], &motion.field[1], &motion.field[2]);
    return motion;
  }
  if (moves()) motion.linear = rigids_.velocityAt(rigids_.at(object_, at), object_, 0);
  return motion;
}

btVector3 ImpactSide::velocity(const SideMotion& motion, const btVector3& at) const {
  return motion.linear + motion.field * (at - centre());
}

btScalar ImpactSide::compliance(const btVector3& at, const btVector3& along) const {
  if (soft_) return static_cast<btScalar>(soft_->dynamics->rigidCompliance(component_, tripleOf(at), tripleOf(along)));
  return moves() ? static_cast<btScalar>(rigids_.compliance(rigids_.at(object_, at), along)) : btScalar(0);
}

void ImpactSide::push(const btVector3& at, const btVector3& impulse) const {
  if (soft_) return soft_->dynamics->push(component_, tripleOf(at), tripleOf(impulse));
  if (moves()) rigids_.push(rigids_.at(object_, at), impulse);
}

double ImpactSide::kept(double energy) const {
  return soft_ ? soft_->dynamics->keptInImpact(component_, energy) : 1.0;
}

double ImpactSide::vibrationBefore() const {
  return soft_ ? soft_->dynamics->vibrationBefore() : 0.0;
}

double ImpactSide::vibration() const {
  return soft_ ? soft_->dynamics->vibrationEnergy() : 0.0;
}

}  // namespace tetskin::bullet_detail
