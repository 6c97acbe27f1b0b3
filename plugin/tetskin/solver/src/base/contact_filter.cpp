// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <tetskin/solver/src/base/contact_filter.h>

namespace tetskin::bullet_detail {
namespace {

/// Tests groups, masks and the callback; true outside of worlds.
bool passesBroadphase(const btSoftBody& body, const btCollisionObject& object) {
  const btSoftBodyWorldInfo* world = const_cast<btSoftBody&>(body).getWorldInfo();
  auto* first = const_cast<btBroadphaseProxy*>(body.getBroadphaseHandle());
  auto* second = const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle());
  if (!world || !world->m_broadphase || !first || !second) return true;
  return world->m_broadphase->getOverlappingPairCache()->needsBroadphaseCollision(first, second);
}

bool isIgnored(const btSoftBody& body, const btCollisionObject& object) {
  const auto& disabled = body.m_collisionDisabledObjects;
  return disabled.findLinearSearch(const_cast<btCollisionObject*>(&object)) < disabled.size() ||
         !body.checkCollideWith(&object) || !object.checkCollideWith(&body);
}

bool collides(const btSoftBody& body, const btCollisionObject& object) {
  return body.hasContactResponse() && object.hasContactResponse() && !isIgnored(body, object) &&
         passesBroadphase(body, object);
}

}  // namespace

bool collidesWithRigid(const btSoftBody& body, const btCollisionObject& object) {
  return (body.m_cfg.collisions & btSoftBody::fCollision::RVSmask) != 0 && collides(body, object);
}

bool collidesWithSoft(const btSoftBody& body, const btSoftBody& other) {
  if (body.m_cfg.collisions == 0 || other.m_cfg.collisions == 0) return false;
  return &body == &other ? body.hasContactResponse() : collides(body, other) && !isIgnored(other, body);
}

}  // namespace tetskin::bullet_detail
