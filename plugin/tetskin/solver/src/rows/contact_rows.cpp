// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/rows/friction_anchors.h>
#include <tetskin/solver/src/rows/position_rounding.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Bound of the velocity at which penetrating bodies are pushed apart, in body sizes per second.
constexpr btScalar kPushingOut = 1;
/// Numbers of contacts that Bullet finds at faces begin here.
constexpr std::uint32_t kFirstFace = 0x80000000U;

int indexIn(const btSoftBody& body, const btSoftBody::Node* node) {
  assert(node >= &body.m_nodes[0] && node < &body.m_nodes[0] + body.m_nodes.size());
  return static_cast<int>(node - &body.m_nodes[0]);
}

/// The common part of all of Bullet's own contacts.
/// speculation  distance that Bullet treats as part of the margin
PointContact bulletsContact(const btSoftBody& body, const btSoftBody::DeformableRigidContact& from,
                            btScalar speculation) {
  PointContact contact;
  contact.body = const_cast<btSoftBody*>(&body);
  contact.object = from.m_cti.m_colObj;
  contact.normal = from.m_cti.m_normal;
  contact.distance = from.m_cti.m_offset + speculation;
  contact.friction = from.m_c3;
  return contact;
}

/// Bullet's own contacts of the body with rigid objects.
void readBulletsContacts(const btSoftBody& body, btScalar speculation, PointContacts& contacts) {
  contacts.clear();
  for (int k = 0; k < body.m_nodeRigidContacts.size(); ++k) {
    const auto& from = body.m_nodeRigidContacts[k];
    PointContact& contact = contacts.emplace_back(bulletsContact(body, from, speculation));
    contact.at.add(indexIn(body, from.m_node), 1);
    contact.point = static_cast<std::uint32_t>(contact.at.nodes[0]);
    contact.position = from.m_node->m_x;
  }
  for (int k = 0; k < body.m_faceRigidContacts.size(); ++k) {
    const auto& from = body.m_faceRigidContacts[k];
    PointContact& contact = contacts.emplace_back(bulletsContact(body, from, speculation));
    contact.point = kFirstFace + static_cast<std::uint32_t>(from.m_face - &body.m_faces[0]);
    contact.position = btVector3(0, 0, 0);
    for (int c = 0; c < 3; ++c) {
      contact.at.add(indexIn(body, from.m_face->m_n[c]), from.m_bary[c]);
      contact.position += from.m_bary[c] * from.m_face->m_n[c]->m_x;
    }
  }
}

bool isFinite(const PointContact& contact) {
  return std::isfinite(contact.distance) && !isNaN(contact.normal) && !isNaN(contact.position);
}

/// The velocity of a point of a body before the solve.
btVector3 velocityBefore(const SolvedBody& body, const CarriedPoint& point) {
  return point.sum([&](int n) { return fromPoint(body.dynamics->velocity(static_cast<std::size_t>(n))); });
}

/// The part of a point's position that rounding has cut off: bodies at rest on something move by less than that.
btVector3 remainderAt(const SolvedBody& body, const CarriedPoint& point) {
  if (!body.elastic) return {0, 0, 0};
  return point.sum([&](int n) {
    btScalar rest[3];
    body.dynamics->remainder(static_cast<std::size_t>(n), rest);
    return fromPoint(rest);
  });
}

/// The velocity of the first end relative to the rigid object in contact, before the solve.
btVector3 relativeVelocity(const SolvedBody& body, const RowOrigin& origin, const RigidPoint& rigid,
                           RigidUnknowns& rigids, btScalar seconds) {
  return velocityBefore(body, origin.points[0]) - rigids.velocityAt(rigid, *origin.object, seconds);
}

/// When Bullet detects contacts, a kinematic body is already where the step takes it. So the gap found there is smaller
/// than at the beginning of the step by the body's motion: this difference.
btScalar leadOf(const ContactRow& row, const btCollisionObject& object, RigidUnknowns& rigids, btScalar seconds) {
  if (!rigids.isLed(object)) return 0;
  return seconds * row.normal.dot(rigids.velocityAt(row.ends[1].rigid, object, seconds));
}

ContactRow rowOf(std::size_t index, const PointContact& contact) {
  ContactRow row;
  row.ends[0].body = index;
  row.normal = contact.normal;
  row.friction = contact.friction;
  return row;
}

RowOrigin originAt(PointContact& contact) {
  assert(contact.object && contact.at.count > 0 && contact.at.count <= kMaxPointNodes);
  RowOrigin origin;
  origin.points = {contact.at, contact.onObject};
  origin.object = contact.object;
  origin.position = contact.position;
  origin.point = contact.point;
  origin.sample = contact.sample;
  origin.contact = &contact;
  return origin;
}

}  // namespace

void ContactRows::collect(SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds) {
  assert(seconds > 0);
  rows_.clear();
  origins_.clear();
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    SolvedBody& body = bodies.bodies()[b];
    if (!body.elastic) continue;
    const std::size_t before = rows_.size();
    addBody(bodies, b, rigids, seconds);
    addAnchors(bodies, b, rigids, seconds);
    body.acted.rowCount = static_cast<int>(rows_.size() - before);
  }
}

void ContactRows::add(const ContactRow& row, const RowOrigin& origin) {
  rows_.push_back(row);
  origins_.push_back(origin);
}

void ContactRows::add(PointContacts& contacts, SolverBodies& bodies, btScalar seconds) {
  assert(seconds > 0);
  for (PointContact& contact : contacts) {
    contact.impulse.setZero();
    const std::size_t index = bodies.indexOf(contact.body);
    if (index == bodies.bodies().size() || !isFinite(contact)) continue;
    assert(contact.onObject.count > 0 && btSoftBody::upcast(contact.object));
    const auto* object = btSoftBody::upcast(contact.object);
    ContactRow row = rowOf(index, contact);
    RowOrigin origin = originAt(contact);
    SolvedBody &body = bodies.bodies()[index], *other = bodies.find(object);
    row.relative = velocityBefore(body, contact.at);
    btVector3 remainder = remainderAt(body, contact.at);
    bool anyFree = contact.at.isFree(*body.body);
    if (other) {
      row.ends[1].body = bodies.indexOf(object);
      row.relative -= velocityBefore(*other, contact.onObject);
      remainder -= remainderAt(*other, contact.onObject);
      anyFree |= contact.onObject.isFree(*other->body);
    }
    if (!anyFree || isNaN(row.relative)) continue;
    const btScalar pushingOut = kPushingOut * std::min(sizeOf(*contact.body), sizeOf(*object));
    const btScalar gap = contact.distance + contact.normal.dot(remainder);
    row.gapVelocity = std::max(seenGap(gap, contact.normal, contact.position) / seconds, -pushingOut);
    warmStart(body, remainder, object->getWorldTransform(), seconds, row, origin);
    add(row, origin);
    ++body.acted.rowCount;
    if (other) ++other->acted.rowCount;
  }
}

void ContactRows::add(std::vector<PointJoint>& joints, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds) {
  assert(seconds > 0);
  for (PointJoint& joint : joints) {
    assert(joint.at.count > 0 && joint.at.count <= kMaxPointNodes && joint.maximum >= 0);
    if (!joint.constant) joint.impulse.setZero();
    const std::size_t index = bodies.indexOf(joint.body);
    if (index == bodies.bodies().size() || isNaN(joint.offset)) continue;
    ContactRow row;
    row.ends[0].body = index;
    row.joined = true;
    row.normal.setValue(0, 1, 0);
    row.directions = joint.directions;
    row.constant = joint.constant;
    row.stiffness = joint.stiffness;
    row.highest = joint.maximum;
    row.offsetVelocity = (joint.offset + remainderAt(bodies.bodies()[index], joint.at)) / seconds;
    if (row.constant) row.impulse = joint.impulse;
    RowOrigin origin;
    origin.points[0] = joint.at;
    origin.joint = &joint;
    origin.object = joint.object;
    origin.position = joint.anchor;
    row.relative = velocityBefore(bodies.bodies()[index], joint.at);
    // A kinematic body moves as the step prescribes.
    if (joint.object && joint.object->isActive() && !joint.object->isKinematicObject()) {
      row.ends[1].rigid = rigids.at(*joint.object, joint.anchor);
      row.relative -= rigids.velocityAt(row.ends[1].rigid, *joint.object, seconds);
    }
    if (!joint.at.isFree(*joint.body) && row.ends[1].rigid.unknown < 0) continue;
    if (isNaN(row.relative)) continue;
    add(row, origin);
    ++bodies.bodies()[index].acted.rowCount;
  }
}

void ContactRows::addBody(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds) {
  SolvedBody& body = bodies.bodies()[index];
  BodyChannel* channel = channelOf(*body.body);
  readBulletsContacts(*body.body, channel ? channel->speculation() : btScalar(0), body.memory->bulletsContacts);
  if (channel) channel->setSpeculation(0);
  const btScalar pushingOut = kPushingOut * sizeOf(*body.body);
  const auto add = [&](PointContact& contact, bool atStart) {
    contact.impulse.setZero();
    if (!contact.object || !contact.object->hasContactResponse() || !isFinite(contact)) return;
    if (!contact.at.isFree(*body.body)) return;
    ContactRow row = rowOf(index, contact);
    RowOrigin origin = originAt(contact);
    row.ends[1].rigid = rigids.at(*contact.object, contact.position);
    row.relative = relativeVelocity(body, origin, row.ends[1].rigid, rigids, seconds);
    if (isNaN(row.relative)) return;
    const btVector3 remainder = remainderAt(body, contact.at);
    const bool found = atStart && rigids.paths().knowsStart(*contact.object);
    const btScalar lead = found ? btScalar(0) : leadOf(row, *contact.object, rigids, seconds);
    const btScalar gap = contact.distance + contact.normal.dot(remainder) + lead;
    row.gapVelocity = std::max(seenGap(gap, contact.normal, contact.position) / seconds, -pushingOut);
    warmStart(body, remainder, rigids.startOf(*contact.object), seconds, row, origin);
    this->add(row, origin);
  };
  for (PointContact& contact : body.memory->bulletsContacts) add(contact, false);
  if (!channel) return;
  for (PointContact& contact : channel->pointContacts()) add(contact, true);
}

void ContactRows::addAnchors(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds) {
  assert(bodies.bodies()[index].elastic);
  const SolvedBody& body = bodies.bodies()[index];
  const auto& anchors = body.body->m_deformableAnchors;
  for (int k = 0; k < anchors.size(); ++k) {
    if (!(anchors[k].m_node->m_im > 0) || !anchors[k].m_cti.m_colObj) continue;
    RowOrigin origin;
    origin.points[0].add(indexIn(*body.body, anchors[k].m_node), 1);
    origin.object = anchors[k].m_cti.m_colObj;
    origin.position = rigids.startOf(*origin.object) * anchors[k].m_local;
    ContactRow row;
    row.ends[0].body = index;
    row.joined = true;
    row.normal.setValue(0, 1, 0);
    row.ends[1].rigid = rigids.at(*origin.object, origin.position);
    row.offsetVelocity = (anchors[k].m_node->m_x + remainderAt(body, origin.points[0]) - origin.position) / seconds;
    row.relative = relativeVelocity(body, origin, row.ends[1].rigid, rigids, seconds);
    add(row, origin);
  }
}

void ContactRows::finish(SolverBodies& bodies, btScalar seconds) const {
  for (SolvedBody& body : bodies.bodies()) {
    body.memory->frictionAnchors.clear();
    body.memory->rows = {};
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ContactRow& row = rows_[r];
    if (origins_[r].contact) origins_[r].contact->impulse = row.impulse;
    if (origins_[r].joint) origins_[r].joint->impulse = row.impulse;
    if (row.state == ContactRow::State::Apart && !row.constant) continue;
    for (const RowEnd& end : row.ends) {
      if (!end.isSoft()) continue;
      RowsOnBody& on = bodies.bodies()[end.body].memory->rows;
      on.any = true;
      on.contacts |= !row.joined;
    }
    if (row.joined || !row.ends[0].isSoft()) continue;
    bodies.bodies()[row.ends[0].body].memory->frictionAnchors.push_back(frictionAnchorOf(row, origins_[r], seconds));
  }
  for (SolvedBody& body : bodies.bodies()) {
    std::stable_sort(body.memory->frictionAnchors.begin(), body.memory->frictionAnchors.end(),
                     [](const FrictionAnchor& a, const FrictionAnchor& b) { return a.point < b.point; });
  }
}

}  // namespace tetskin::bullet_detail
