// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/contact/src/rigid/body_contacts.h>
#include <tetskin/contact/src/rigid/node_contacts.h>

#include <algorithm>
#include <utility>

namespace tetskin {
namespace {

/// Shapes that are remembered, each with some 100 bytes a tet.
constexpr std::size_t kMostKnown = 64;

/// Where an object goes in this step. Of those that do not move by themselves, or sleep, nobody keeps that up to date.
btTransform predictedOf(const btCollisionObject& object) {
  const bool moves = object.isActive() && !object.isStaticOrKinematicObject();
  return moves ? object.getInterpolationWorldTransform() : object.getWorldTransform();
}

/// Of a shape on the object: a child of a compound has a place there.
ShapePath pathOf(const btCollisionObjectWrapper& rigid) {
  const btCollisionObject& object = *rigid.getCollisionObject();
  const btTransform place = object.getWorldTransform().inverse() * rigid.getWorldTransform();
  return {rigid.getWorldTransform(), predictedOf(object) * place};
}

}  // namespace

BodyContacts::BodyContacts(const btDispatcher& dispatcher, btSoftBody& body, TouchSearch search, btScalar thickness)
    : dispatcher_(&dispatcher),
      body_(body),
      lifetime_(bodyWithTrees(body)->lifetime()),
      search_(std::move(search)),
      thickness_(thickness) {}

void BodyContacts::collide(const btCollisionObjectWrapper& rigid) {
  const btCollisionObject& object = *rigid.getCollisionObject();
  if (!body_.isActive() || !responds(object)) return;
  // Bullet clears its contacts in each step.
  const auto kept = static_cast<std::size_t>(body_.m_nodeRigidContacts.size());
  if (touches_.size() > kept) touches_.resize(kept);
  nodesRead_ = false;
  shapeNumber_ = 0;
  collideShape(*rigid.getCollisionShape(), pathOf(rigid), object);
}

bool BodyContacts::responds(const btCollisionObject& object) const {
  const auto& disabled = body_.m_collisionDisabledObjects;
  const bool meetsRigids = (body_.m_cfg.collisions & btSoftBody::fCollision::RVSmask) != 0;
  return meetsRigids && object.hasContactResponse() && body_.hasContactResponse() &&
         disabled.findLinearSearch(const_cast<btCollisionObject*>(&object)) == disabled.size();
}

void BodyContacts::readNodes() {
  if (nodesRead_) return;
  nodesRead_ = true;
  nodes_.resize(static_cast<std::size_t>(body_.m_nodes.size()));
  for (int n = 0; n < body_.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body_.m_nodes[n];
    nodes_[static_cast<std::size_t>(n)] = {node.m_x, node.m_x + body_.m_sst.sdt * node.m_v};
  }
  search_.begin(nodes_);
}

/// By the boxes that Bullet keeps, and for shapes of one piece by the distance of the body's.
bool BodyContacts::isNear(const btCollisionShape& shape, const ShapePath& path) const {
  btVector3 low, high, laterLow, laterHigh;
  shape.getAabb(path.now, low, high);
  shape.getAabb(path.predicted, laterLow, laterHigh);
  low.setMin(laterLow);
  high.setMax(laterHigh);
  const btBroadphaseProxy* body = body_.getBroadphaseHandle();
  if (!body) return true;
  for (int k = 0; k < 3; ++k) {
    if (low[k] > body->m_aabbMax[k] || high[k] < body->m_aabbMin[k]) return false;
  }
  return true;
}

void BodyContacts::collideShape(const btCollisionShape& shape, const ShapePath& path, const btCollisionObject& object) {
  ++shapeNumber_;
  if (!isNear(shape, path)) return;
  if (shape.isCompound()) return collideChildren(shape, path, object);
  ShapeProbe* probe = probeOf(shape);
  if (!probe) return;
  readNodes();
  ShapeMemory& memory = memoryOf(shape, object);
  for (const NodeTouch& touch : search_.find(*probe, path, memory)) {
    if (addNodeContact(body_, object, touch)) touches_.push_back(touch);
  }
}

void BodyContacts::collideChildren(const btCollisionShape& compound, const ShapePath& path,
                                   const btCollisionObject& object) {
  const auto& children = static_cast<const btCompoundShape&>(compound);
  for (int c = 0; c < children.getNumChildShapes(); ++c) {
    const btTransform& place = children.getChildTransform(c);
    collideShape(*children.getChildShape(c), {path.now * place, path.predicted * place}, object);
  }
}

void BodyContacts::forget(const btCollisionObject& object) {
  const auto isOf = [&](const KnownShape& known) { return known.object == &object; };
  known_.erase(std::remove_if(known_.begin(), known_.end(), isOf), known_.end());
  if (!bodyLives()) return;
  const auto kept = static_cast<std::size_t>(body_.m_nodeRigidContacts.size());
  for (std::size_t k = 0; k < std::min(kept, touches_.size()); ++k) {
    if (body_.m_nodeRigidContacts[static_cast<int>(k)].m_cti.m_colObj == &object) touches_[k].node = -1;
  }
}

ShapeMemory& BodyContacts::memoryOf(const btCollisionShape& shape, const btCollisionObject& object) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  for (KnownShape& known : known_) {
    if (known.object != &object || known.number != shapeNumber_) continue;
    if (known.shape != &shape || known.low != low || known.high != high) known = {};
    known.object = &object;
    known.number = shapeNumber_;
    known.shape = &shape;
    known.low = low;
    known.high = high;
    return known.memory;
  }
  if (known_.size() >= kMostKnown) return overflow_ = {};
  known_.push_back({&object, shapeNumber_, &shape, low, high, {}});
  return known_.back().memory;
}

ShapeProbe* BodyContacts::probeOf(const btCollisionShape& shape) {
  if (const std::optional<ExactShape> exact = ExactShape::of(shape)) {
    exact_.take(*exact);
    return &exact_;
  }
  if (shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE && hull_.take(static_cast<const btConvexHullShape&>(shape))) {
    return &hull_;
  }
  if (shape.isConvex() && !shape.isConvex2d()) {
    convex_.take(static_cast<const btConvexShape&>(shape));
    return &convex_;
  }
  if (!shape.isConcave()) return nullptr;
  mesh_.take(static_cast<const btConcaveShape&>(shape), thickness_);
  return &mesh_;
}

}  // namespace tetskin
