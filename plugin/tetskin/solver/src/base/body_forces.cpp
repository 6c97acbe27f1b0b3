// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/base/body_forces.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

btDeformableLagrangianForce* noForce() {
  static InactiveForce force;
  return &force;
}

}  // namespace

bool isPlaceholder(const btDeformableLagrangianForce* force) {
  return force == noForce();
}

bool needsDeformation(btDeformableLagrangianForce& force) {
  if (isSilent(force)) return false;
  if (OwnObject::is(OwnObject::Kind::BodyGravity, &force)) return false;
  const btDeformableLagrangianForceType type = force.getForceType();
  return type != BT_GRAVITY_FORCE && type != BT_MASSSPRING_FORCE && type != BT_MOUSE_PICKING_FORCE;
}

void replaceByNothing(ForceList& list, const btDeformableLagrangianForce* force) {
  for (int i = 0; i < list.size(); ++i) {
    if (list[i] == force) list[i] = noForce();
  }
}

void removeFromList(ForceList& list, const btDeformableLagrangianForce* force) {
  int kept = 0;
  for (int i = 0; i < list.size(); ++i) {
    if (list[i] != force) list[kept++] = list[i];
  }
  list.resizeNoInitialize(kept);
}

void addToList(ForceList& list, BodyGravity& gravity, btDeformableLagrangianForce& elasticity, btSoftBody& body) {
  assert(gravity.m_softBodies.size() == 0 && elasticity.m_softBodies.size() == 0);
  removeFromList(list, noForce());
  list.push_back(nullptr);
  for (int i = list.size() - 1; i > 0; --i) list[i] = list[i - 1];
  list[0] = &gravity;
  list.push_back(&elasticity);
  for (btDeformableLagrangianForce* force : {static_cast<btDeformableLagrangianForce*>(&gravity), &elasticity}) {
    force->addSoftBody(&body);
  }
}

BodyGravity::BodyGravity(btDeformableMultiBodyDynamicsWorld& world, ForceList& list, bool isToldOfRemovals,
                         BodyOwner& owner)
    : OwnForce<btDeformableGravityForce>(list, world.getGravity()),
      world_(&world),
      isToldOfRemovals_(isToldOfRemovals),
      owner_(owner) {}

void BodyGravity::setWorld(btDeformableMultiBodyDynamicsWorld& world, ForceList& list, bool isToldOfRemovals) {
  assert(m_softBodies.size() == 0);
  setList(list);
  world_ = &world;
  isToldOfRemovals_ = isToldOfRemovals;
  removed_ = nullptr;
}

btDeformableLagrangianForceType BodyGravity::getForceType() {
  return inCallback_ ? BT_GRAVITY_FORCE : kOwnForceType;
}

void BodyGravity::removeSoftBody(btSoftBody* body) {
  if (isToldOfRemovals_) removed_ = body;
  OwnForce::removeSoftBody(body);
}

void BodyGravity::reinitialize(bool) {
  // Between a removal and the next substep the application may add forces, which must not join this one.
  const bool removal = removed_ && !removed_->getBroadphaseHandle();
  removed_ = nullptr;
  inCallback_ = !removal;
  const btVector3 before = m_gravity;
  m_gravity = next();
  for (int i = 0; i < m_softBodies.size(); ++i) {
    updateConstants(*m_softBodies[i]);
    if (m_gravity != before) m_softBodies[i]->activate();
  }
}

/// A change of gravity wakes the body; restoring it does not.
void BodyGravity::serialize(WorldStream& stream) {
  bool isSet = own_.has_value();
  stream(isSet);
  if (stream.restoring()) own_ = isSet ? std::optional<btVector3>(m_gravity) : std::nullopt;
  if (isSet) stream(*own_);
  stream(m_gravity);
  owner_.serialize(stream);
}

/// Explicit worlds do not ask for gravity.
void BodyGravity::addScaledExplicitForce(btScalar scale, TVStack& force) {
  inCallback_ = false;
  OwnForce::addScaledExplicitForce(scale, force);
}

/// In implicit worlds, this is called after Bullet has asked for gravity, and before it applies the answer.
void BodyGravity::addScaledHessian(btScalar scale) {
  const btVector3 difference = m_gravity - requestedGravity();
  inCallback_ = false;
  if (difference.fuzzyZero()) return;
  for (int i = 0; i < m_softBodies.size(); ++i) {
    btSoftBody& body = *m_softBodies[i];
    if (!body.isActive()) continue;
    for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_v += scale * body.m_gravityFactor * difference;
  }
}

void BodyGravity::addScaledForces(btScalar scale, TVStack& force) {
  OwnForce::addScaledForces(scale, force);
  stopSleepers();
}

void BodyGravity::addScaledDampingForce(btScalar scale, TVStack& force) {
  OwnForce::addScaledDampingForce(scale, force);
  stopSleepers();
}

void BodyGravity::stopSleepers() {
  for (int i = 0; i < m_softBodies.size(); ++i) {
    btSoftBody& body = *m_softBodies[i];
    if (body.isActive()) continue;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      body.m_nodes[n].m_v.setZero();
      body.m_nodes[n].m_splitv.setZero();
    }
  }
}

/// The gravity that Bullet has found. Forces of this library that come after this one still answer, so there is always
/// one.
btVector3 BodyGravity::requestedGravity() const {
  for (int i = list_->size() - 1; i >= 0; --i) {
    if ((*list_)[i]->getForceType() != BT_GRAVITY_FORCE) continue;
    return static_cast<const btDeformableGravityForce*>((*list_)[i])->m_gravity;
  }
  assert(false && "Bullet asked for gravity, but this force was not in the list");
  return m_gravity;
}

}  // namespace tetskin::bullet_detail
