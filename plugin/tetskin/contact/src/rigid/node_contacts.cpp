// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Bullet 3.24, BulletSoftBody/btSoftBodyInternals.h, CollideSDF_RD (what the solver expects of a contact)
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <tetskin/contact/src/rigid/node_contacts.h>

namespace tetskin {
namespace {

using NodeContact = btSoftBody::DeformableNodeRigidContact;

void setUpRigid(const btCollisionObject& object, const btVector3& position, NodeContact& contact) {
  const btRigidBody* rigid = btRigidBody::upcast(&object);
  const btVector3 arm = position - object.getWorldTransform().getOrigin();
  const btMatrix3x3 noInertia(0, 0, 0, 0, 0, 0, 0, 0, 0);
  contact.m_c1 = arm;
  contact.m_c0 = ImpulseMatrix(1, contact.m_c5, rigid ? rigid->getInvMass() : 0,
                               rigid ? rigid->getInvInertiaTensorWorld() : noInertia, arm);
}

void setUpLink(const btMultiBodyLinkCollider& link, const btVector3& position, NodeContact& contact) {
  const btVector3 normal = contact.m_cti.m_normal;
  contact.t1 = generateUnitOrthogonalVector(normal);
  contact.t2 = btCross(normal, contact.t1);
  findJacobian(&link, contact.jacobianData_normal, position, normal);
  findJacobian(&link, contact.jacobianData_t1, position, contact.t1);
  findJacobian(&link, contact.jacobianData_t2, position, contact.t2);
  const auto rowOf = [](const btMultiBodyJacobianData& data) { return &data.m_jacobians[0]; };
  const auto rateOf = [](const btMultiBodyJacobianData& data) { return &data.m_deltaVelocitiesUnitImpulse[0]; };
  const btMatrix3x3 toContact(normal.x(), normal.y(), normal.z(), contact.t1.x(), contact.t1.y(), contact.t1.z(),
                              contact.t2.x(), contact.t2.y(), contact.t2.z());
  // The node's in the contact's directions, as the link's is.
  const btMatrix3x3 node = toContact * contact.m_c5 * toContact.transpose();
  const btMatrix3x3 ofLink =
      OuterProduct(rowOf(contact.jacobianData_normal), rowOf(contact.jacobianData_t1), rowOf(contact.jacobianData_t2),
                   rateOf(contact.jacobianData_normal), rateOf(contact.jacobianData_t1),
                   rateOf(contact.jacobianData_t2), link.m_multiBody->getNumDofs() + 6);
  contact.m_c0 = toContact.transpose() * (node + ofLink).inverse() * toContact;
}

}  // namespace

bool addNodeContact(btSoftBody& body, const btCollisionObject& object, const NodeTouch& touch) {
  btSoftBody::Node& node = body.m_nodes[touch.node];
  if (!(node.m_im > 0) || node.m_battach) return false;
  NodeContact contact;
  contact.m_node = &node;
  contact.t1.setZero();
  contact.t2.setZero();
  contact.m_cti.m_colObj = &object;
  contact.m_cti.m_normal = touch.normal;
  contact.m_cti.m_offset = touch.room;
  contact.m_c2 = node.m_im;
  contact.m_c3 = body.m_cfg.kDF * object.getFriction();
  contact.m_c4 = object.isStaticOrKinematicObject() ? body.m_cfg.kKHR : body.m_cfg.kCHR;
  contact.m_c5 = node.m_effectiveMass_inv;
  const auto* link = btMultiBodyLinkCollider::upcast(&object);
  link ? setUpLink(*link, touch.position, contact) : setUpRigid(object, touch.position, contact);
  body.m_nodeRigidContacts.push_back(contact);
  if (!object.isActive()) object.activate();
  return true;
}

}  // namespace tetskin
