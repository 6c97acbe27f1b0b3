// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <tetskin/bullet/src/shared/bodies/exact_distance.h>
#include <tetskin/bullet/src/solver/node_contacts.h>

#include <cassert>
#include <optional>

namespace tetskin {
namespace {

/// Where Bullet predicts the object to be at the end of the step.
btTransform predictedTransform(const btCollisionObjectWrapper& object) {
  const btTransform& whole = object.getCollisionObject()->getInterpolationWorldTransform();
  return object.m_preTransform ? whole * *object.m_preTransform : whole;
}

/// The box of the shape, now and as predicted, enlarged by the margin.
BvhBox<btScalar> boxOf(const btCollisionObjectWrapper& object, const btTransform& predicted, btScalar margin) {
  BvhBox<btScalar> box;
  for (const btTransform& transform : {object.getWorldTransform(), predicted}) {
    btVector3 low, high;
    object.getCollisionShape()->getAabb(transform, low, high);
    box.extend(low, high);
  }
  return box.grownBy(margin);
}

/// Bullet passes a plane as two triangles around the place where its box and the body's met first; it keeps these
/// triangles, so that a body that moves on would leave them and fall.
bool isPartOfPlane(const btCollisionObjectWrapper& object) {
  const btCollisionShape* whole = object.getCollisionObject()->getCollisionShape();
  return whole->getShapeType() == STATIC_PLANE_PROXYTYPE && object.getCollisionShape() != whole;
}

/// The contacts with an object are found one after the other.
bool hasContactsWith(const btSoftBody& body, const btCollisionObject& object) {
  const auto& contacts = body.m_nodeRigidContacts;
  return contacts.size() > 0 && contacts[contacts.size() - 1].m_cti.m_colObj == &object;
}

/// Distances of points from a shape, less the margin.
class ShapeField {
 public:
  ShapeField(btSoftBody& body, const btCollisionShape& shape)
      : exact_(ExactShape::exactShape(shape)),
        sparse_(body.getWorldInfo()->m_sparsesdf),
        shape_(shape),
        margin_(body.getCollisionShape()->getMargin()) {}

  /// point  in the shape's space
  ShapeDistance at(const btVector3& point) const {
    ShapeDistance found;
    if (exact_) {
      found = exact_->distance(point);
      found.distance -= margin_;
    } else {
      found.distance = sparse_.Evaluate(point, &shape_, found.normal, margin_);
    }
    return found;
  }

 private:
  std::optional<ExactShape> exact_;
  btSparseSdf<3>& sparse_;
  const btCollisionShape& shape_;
  btScalar margin_;
};

btSoftBody::DeformableNodeRigidContact contactOf(const btSoftBody& body, btSoftBody::Node& node,
                                                 const btCollisionObjectWrapper& object, const ShapeDistance& at) {
  const btCollisionObject& whole = *object.getCollisionObject();
  btSoftBody::DeformableNodeRigidContact contact;
  contact.m_node = &node;
  contact.m_cti.m_colObj = &whole;
  contact.m_cti.m_normal = object.getWorldTransform().getBasis() * at.normal;
  contact.m_cti.m_offset = at.distance;
  contact.m_c0.setIdentity();
  contact.m_c1.setZero();
  contact.m_c2 = node.m_im;
  contact.m_c3 = body.m_cfg.kDF * whole.getFriction();
  contact.m_c4 = whole.isStaticOrKinematicObject() ? body.m_cfg.kKHR : body.m_cfg.kCHR;
  contact.m_c5 = node.m_effectiveMass_inv;
  return contact;
}

}  // namespace

void findNodeContacts(btSoftBody& body, const btCollisionObjectWrapper& object, NodePaths& paths, bool solved) {
  assert(body.getWorldInfo() && object.getCollisionShape());
  if (solved && isPartOfPlane(object)) {
    const btCollisionObject& whole = *object.getCollisionObject();
    const btCollisionObjectWrapper plane(nullptr, whole.getCollisionShape(), &whole, whole.getWorldTransform(), -1, -1);
    if (!hasContactsWith(body, whole)) findNodeContacts(body, plane, paths, solved);
    return;
  }
  const btRigidBody* rigid = btRigidBody::upcast(object.getCollisionObject());
  const btTransform predicted = predictedTransform(object);
  const btScalar margin = body.getCollisionShape()->getMargin();
  const BvhBox<btScalar> box = boxOf(object, predicted, margin);
  const std::vector<int>& near = paths.near(box);
  if (near.empty()) return;
  if (!solved) {
    btSoftColliders::CollideSDF_RD bullets;
    bullets.psb = &body;
    bullets.m_colObj1Wrap = &object;
    bullets.m_rigidBody = const_cast<btRigidBody*>(rigid);
    bullets.dynmargin = bullets.stamargin = margin;
    // Bullet's test of a node reads the node and its distance field; the boxes in its own tree have the margin, too.
    const BvhBox<btScalar> around = box.grownBy(margin);
    for (const int n : near) {
      if (paths.boxOf(n).collides(around)) bullets.DoNode(body.m_nodes[n]);
    }
    return;
  }
  const ShapeField field(body, *object.getCollisionShape());
  for (const int n : near) {
    btSoftBody::Node& node = body.m_nodes[n];
    const bool held = node.m_im == 0 && (!rigid || rigid->getInvMass() == 0);
    if (node.m_battach != 0 || held || !(field.at(predicted.invXform(paths[n].predicted)).distance < 0)) continue;
    const ShapeDistance now = field.at(object.getWorldTransform().invXform(paths[n].now));
    body.m_nodeRigidContacts.push_back(contactOf(body, node, object, now));
  }
}

}  // namespace tetskin
