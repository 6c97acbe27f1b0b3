// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/bullet/src/solver/contact_rows.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// D over effective masses: gaps are violated by a twentieth of what the nodes alone would move. With 0.01, a box of
/// `tetskin_contact` (stop/equal steps/k50) stops 3 % too early.
constexpr double kStiffness = 20.0;
/// By how much of the body's size an impact may violate a gap: D is so much higher where a twentieth of the way towards
/// the object in this step is more. Without, what is fast goes a twentieth of its way deep, and passes thin walls.
constexpr double kViolation = 1e-3;
/// Most by which D is raised for this: in float, more is lost in rounding.
constexpr double kMostStiffening = 100.0;
/// The way that gravity adds in a step is left out, so many times: a small body at rest falls by a visible part of its
/// size in each step, and jumps on contacts that are stiff to that.
constexpr btScalar kFallsAtRest = 2;
/// T over D. Slopes and stops keep their promises in `tetskin_contact` with 0.0003 and with 100, too, as the
/// offset of what sticks grows until it suffices. But 100 takes 19 iterations per step in stop/equal steps/k50, where
/// this value takes 4.
constexpr btScalar kTangentShare = btScalar(0.3);
/// D of joints over effective masses. Anchors begin at the same value: a higher one costs iterations without a visible
/// difference.
constexpr double kAnchorStiffness = 1000.0;
/// Body's sizes per second: bound of the velocity at which penetrating bodies are pushed apart.
constexpr btScalar kPushingOut = 1;
/// Rounding of a position, in units of the last digit.
constexpr btScalar kPositionDigits = 2;
/// Weights below this one are ignored where rows share a node.
constexpr btScalar kSmallWeight = btScalar(0.02);
/// Cosine: contacts of one point whose normals differ by less than this angle count as the same contact from step to
/// step.
constexpr btScalar kSameNormal = btScalar(0.7);
/// Contacts that Bullet finds at faces are numbered from here on.
constexpr std::uint32_t kFirstFace = 0x80000000U;

std::array<double, 3> numbersOf(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

void addNode(int node, btScalar weight, PointContact& contact) {
  assert(contact.nodeCount < kMaxPointNodes);
  contact.nodes[contact.nodeCount] = node;
  contact.weights[contact.nodeCount++] = weight;
}

int indexIn(const btSoftBody& body, const btSoftBody::Node* node) {
  assert(node >= &body.m_nodes[0] && node < &body.m_nodes[0] + body.m_nodes.size());
  return static_cast<int>(node - &body.m_nodes[0]);
}

/// What all of Bullet's own contacts have in common.
/// speculation  distance that Bullet takes for part of the margin
PointContact bulletsContact(const btSoftBody::DeformableRigidContact& from, btScalar speculation) {
  PointContact contact;
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
    PointContact& contact = contacts.emplace_back(bulletsContact(from, speculation));
    addNode(indexIn(body, from.m_node), 1, contact);
    contact.point = static_cast<std::uint32_t>(contact.nodes[0]);
    contact.position = from.m_node->m_x;
  }
  for (int k = 0; k < body.m_faceRigidContacts.size(); ++k) {
    const auto& from = body.m_faceRigidContacts[k];
    PointContact& contact = contacts.emplace_back(bulletsContact(from, speculation));
    contact.point = kFirstFace + static_cast<std::uint32_t>(from.m_face - &body.m_faces[0]);
    contact.position = btVector3(0, 0, 0);
    for (int c = 0; c < 3; ++c) {
      addNode(indexIn(body, from.m_face->m_n[c]), from.m_bary[c], contact);
      contact.position += from.m_bary[c] * from.m_face->m_n[c]->m_x;
    }
  }
}

bool isFinite(const PointContact& contact) {
  return std::isfinite(contact.distance) && !isNaN(contact.normal) && !isNaN(contact.position);
}

bool isFree(const SolverBodies& bodies, const RowEnd& end) {
  for (std::uint32_t k = 0; k < end.nodeCount; ++k) {
    if (bodies.bodies()[end.body].body->m_nodes[end.nodes[k]].m_im > 0) return true;
  }
  return false;
}

/// The end's velocity before the solve; 0 if no nodes carry it.
btVector3 carriedVelocity(const SolverBodies& bodies, const RowEnd& end) {
  assert(end.nodeCount <= kMaxPointNodes && end.body < bodies.bodies().size());
  btVector3 sum(0, 0, 0);
  for (std::uint32_t k = 0; k < end.nodeCount; ++k) {
    const auto node = static_cast<std::size_t>(end.nodes[k]);
    sum += end.weights[k] * fromPoint(bodies.bodies()[end.body].dynamics->velocity(node));
  }
  return sum;
}

/// The velocity of the first end relative to the rigid object that it meets, before the solve.
btVector3 relativeVelocity(const SolverBodies& bodies, const ContactRow& row, RigidUnknowns& rigids, btScalar seconds) {
  return carriedVelocity(bodies, row.ends[0]) - rigids.velocityAt(row.ends[1].rigid, *row.object, seconds);
}

/// When contacts are detected, a kinematic body is already at the position where the step takes it. The gap found then
/// is smaller than at the beginning of the step by how much the body moves: this difference.
btScalar leadOf(const ContactRow& row, RigidUnknowns& rigids, btScalar seconds) {
  if (!rigids.isLed(*row.object)) return 0;
  return seconds * row.normal.dot(rigids.velocityAt(row.ends[1].rigid, *row.object, seconds));
}

ContactRow rowOf(std::size_t index, PointContact& contact) {
  assert(contact.object && contact.nodeCount > 0 && contact.nodeCount <= kMaxPointNodes);
  ContactRow row;
  row.ends[0].body = index;
  row.ends[0].nodeCount = contact.nodeCount;
  row.ends[0].nodes = contact.nodes;
  row.ends[0].weights = contact.weights;
  row.contact = &contact;
  row.point = contact.point;
  row.object = contact.object;
  row.position = contact.position;
  row.normal = contact.normal;
  row.friction = contact.friction;
  return row;
}

/// Rounding of a position, by axis: far from the origin, a depth of one last digit must not be pushed out.
btVector3 roundingOf(const btVector3& position) {
  return kPositionDigits * SIMD_EPSILON * position.absolute();
}

btScalar seenGap(btScalar gap, const ContactRow& row) {
  return gap < 0 ? std::min(gap + row.normal.absolute().dot(roundingOf(row.position)), btScalar(0)) : gap;
}

/// The offset without its components that are below the rounding.
btVector3 visibleOffset(const btVector3& offset, const btVector3& position) {
  const btVector3 rounding = roundingOf(position);
  btVector3 seen = offset;
  for (int k = 0; k < 3; ++k) {
    if (btFabs(offset[k]) <= rounding[k]) seen[k] = 0;
  }
  return seen;
}

/// Reads from the step before where the point sticks, and the impulse that acted on it.
/// frame  the object's
void warmStart(const SolvedBody& body, const btTransform& frame, btScalar seconds, ContactRow& row) {
  assert(body.frictionAnchors && seconds > 0);
  row.stickingPosition = frame.invXform(row.position);
  const auto less = [](const FrictionAnchor& a, const FrictionAnchor& b) { return a.point < b.point; };
  FrictionAnchor key;
  key.point = row.point;
  const auto range = std::equal_range(body.frictionAnchors->begin(), body.frictionAnchors->end(), key, less);
  for (auto known = range.first; known != range.second; ++known) {
    if (known->object != row.object || known->normal.dot(row.normal) < kSameNormal) continue;
    row.stickingPosition = known->position;
    btVector3 offset = row.ends[1].isSoft() ? known->position : row.position - frame * known->position;
    offset -= row.normal.dot(offset) * row.normal;
    row.offsetVelocity = visibleOffset(offset, row.position) / seconds;
    row.normalBound = known->normalForce * seconds;
    row.stuck = known->stuck;
    return;
  }
}

/// Inverse effective mass of an end's point in a direction: that of its nodes by themselves, plus that of the rigid
/// motion of their component.
double compliance(const SolvedBody& body, const RowEnd& end, const btVector3& position, const btVector3& direction) {
  assert(end.isSoft());
  double sum = 0.0;
  for (std::uint32_t k = 0; k < end.nodeCount; ++k) {
    btScalar inverse[6];
    body.dynamics->matrix().freeInverse(static_cast<std::size_t>(end.nodes[k]), inverse);
    sum += static_cast<double>(end.weights[k] * end.weights[k] * direction.dot(symmetricMatrix(inverse) * direction));
  }
  const auto node = static_cast<std::size_t>(end.nodes[0]);
  return sum + body.dynamics->rigidCompliance(node, numbersOf(position), numbersOf(direction));
}

double effectiveMass(const SolverBodies& bodies, const ContactRow& row, const RigidUnknowns& rigids) {
  const auto along = [&](const btVector3& direction) {
    double sum = 0.0;
    for (const RowEnd& end : row.ends) {
      sum += end.isSoft() ? compliance(bodies.bodies()[end.body], end, row.position, direction)
                          : rigids.compliance(end.rigid, direction);
    }
    return sum;
  };
  const double sum = row.joined ? (along({1, 0, 0}) + along({0, 1, 0}) + along({0, 0, 1})) / 3 : along(row.normal);
  return sum > 0.0 ? 1.0 / sum : 0.0;
}

/// The offset from the sticking position at the end of the step; where the point slides, the offset that friction can
/// hold.
FrictionAnchor frictionAnchorOf(const ContactRow& row, btScalar seconds) {
  assert(row.object && seconds > 0);
  FrictionAnchor kept;
  kept.point = row.point;
  kept.object = row.object;
  kept.normal = row.normal;
  const btScalar along = row.normal.dot(row.impulse);
  kept.normalForce = along / seconds;
  kept.position = row.stickingPosition;
  kept.stuck = row.state == ContactRow::State::Sticks;
  if (row.ends[1].isSoft()) kept.position = (row.slip + row.offsetVelocity) * seconds;
  if (row.state != ContactRow::State::Slides || !(row.tangentStiffness > 0)) return kept;
  const btVector3 reached = (row.slip + row.offsetVelocity) * seconds;
  const btVector3 held = -(row.impulse - along * row.normal) * (seconds / row.tangentStiffness);
  if (row.ends[1].isSoft()) {
    kept.position = held;
    return kept;
  }
  kept.position += row.object->getWorldTransform().getBasis().transpose() * (reached - held);
  return kept;
}

/// The factor of a contact's D by which the way towards the object violates the gap no more than is seen.
double stiffening(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) {
  assert(!row.joined && row.ends[0].isSoft());
  btScalar size = sizeOf(*bodies.bodies()[row.ends[0].body].body);
  if (row.ends[1].isSoft()) size = std::min(size, sizeOf(*bodies.bodies()[row.ends[1].body].body));
  const SolvedBody& body = bodies.bodies()[row.ends[0].body];
  // The world is not known of a body that has been moved to another one since.
  const bool known = body.elastic && body.elastic->world && body.body->getWorldInfo() == body.elastic->worldInfo;
  const btScalar falls = known ? body.elastic->world->getGravity().length() * seconds : btScalar(0);
  const btScalar towards = -row.normal.dot(row.relative) - row.gapVelocity - kFallsAtRest * falls;
  const auto way = static_cast<double>(towards * seconds), seen = kStiffness * kViolation * static_cast<double>(size);
  return way > seen ? std::min(way / seen, kMostStiffening) : 1.0;
}

}  // namespace

void ContactRows::collect(SolverBodies& bodies, RigidUnknowns& rigids, const std::vector<RowSource*>& sources,
                          btScalar seconds, ParallelFor* threads, StepClock& clock) {
  assert(seconds > 0);
  rows_.clear();
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    SolvedBody& body = bodies.bodies()[b];
    if (!body.elastic) continue;
    const std::size_t before = rows_.size();
    addBody(bodies, b, rigids, seconds);
    addAnchors(bodies, b, rigids, seconds);
    body.rowCount = static_cast<int>(rows_.size() - before);
  }
  for (RowSource* source : sources) {
    clock.end(&StepTimes::rows);
    auto* contacts = source->contacts(seconds, threads);
    clock.end(&StepTimes::softSearch);
    if (contacts) {
      for (SoftPointContact& contact : *contacts) addSoft(bodies, contact, seconds);
    }
    if (auto* joints = source->joints(seconds)) {
      for (PointJoint& joint : *joints) addJoint(bodies, joint, rigids, seconds);
    }
  }
  setStiffness(bodies, rigids, seconds);
}

/// Rows do not move sleeping bodies.
void ContactRows::addSoft(SolverBodies& bodies, SoftPointContact& contact, btScalar seconds) {
  contact.impulse.setZero();
  const std::size_t index = bodies.indexOf(contact.body);
  if (index == bodies.bodies().size() || !isFinite(contact)) return;
  ContactRow row = rowOf(index, contact);
  assert(contact.nodeCount > 0 && btSoftBody::upcast(contact.object));
  const auto* object = btSoftBody::upcast(contact.object);
  const std::size_t other = bodies.indexOf(object);
  const bool moves = other < bodies.bodies().size();
  if (moves) {
    row.ends[1].body = other;
    row.ends[1].nodeCount = 4;
    std::copy(contact.objectNodes.begin(), contact.objectNodes.end(), row.ends[1].nodes.begin());
    std::copy(contact.objectWeights.begin(), contact.objectWeights.end(), row.ends[1].weights.begin());
  }
  row.relative = carriedVelocity(bodies, row.ends[0]) - carriedVelocity(bodies, row.ends[1]);
  const bool anyFree = isFree(bodies, row.ends[0]) || isFree(bodies, row.ends[1]);
  if (!anyFree || isNaN(row.relative)) return;
  const btScalar pushingOut = kPushingOut * std::min(sizeOf(*contact.body), sizeOf(*object));
  row.gapVelocity = std::max(seenGap(contact.distance, row) / seconds, -pushingOut);
  warmStart(bodies.bodies()[index], object->getWorldTransform(), seconds, row);
  rows_.push_back(row);
  for (const RowEnd& end : row.ends) {
    if (end.isSoft()) ++bodies.bodies()[end.body].rowCount;
  }
}

/// Sleeping bodies do not move.
void ContactRows::addJoint(SolverBodies& bodies, PointJoint& joint, RigidUnknowns& rigids, btScalar seconds) {
  assert(joint.nodeCount > 0 && joint.nodeCount <= kMaxPointNodes && joint.maximum >= 0);
  if (!joint.constant) joint.impulse.setZero();
  const std::size_t index = bodies.indexOf(joint.body);
  if (index == bodies.bodies().size() || isNaN(joint.offset)) return;
  ContactRow row;
  row.ends[0].body = index;
  row.ends[0].nodeCount = joint.nodeCount;
  row.ends[0].nodes = joint.nodes;
  row.ends[0].weights = joint.weights;
  row.joined = true;
  row.joint = &joint;
  row.object = joint.object;
  row.position = joint.anchor;
  row.normal.setValue(0, 1, 0);
  row.directions = joint.directions;
  row.constant = joint.constant;
  row.stiffness = joint.stiffness;
  row.highest = joint.maximum;
  row.offsetVelocity = joint.offset / seconds;
  if (row.constant) row.impulse = joint.impulse;
  row.relative = carriedVelocity(bodies, row.ends[0]);
  // A kinematic body moves as the step prescribes.
  if (row.object && row.object->isActive() && !row.object->isKinematicObject()) {
    row.ends[1].rigid = rigids.at(*row.object, row.position);
    row.relative -= rigids.velocityAt(row.ends[1].rigid, *row.object, seconds);
  }
  if (!isFree(bodies, row.ends[0]) && row.ends[1].rigid.unknown < 0) return;
  if (isNaN(row.relative)) return;
  rows_.push_back(row);
  ++bodies.bodies()[index].rowCount;
}

void ContactRows::addBody(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds) {
  SolvedBody& body = bodies.bodies()[index];
  auto* own = bodyWithTrees(*body.body);
  readBulletsContacts(*body.body, own ? own->speculation() : btScalar(0), *body.bulletsContacts);
  if (own) own->setSpeculation(0);
  const btScalar pushingOut = kPushingOut * sizeOf(*body.body);
  const auto add = [&](PointContact& contact) {
    contact.impulse.setZero();
    if (!contact.object || !contact.object->hasContactResponse() || !isFinite(contact)) return;
    ContactRow row = rowOf(index, contact);
    if (!isFree(bodies, row.ends[0])) return;
    row.ends[1].rigid = rigids.at(*row.object, row.position);
    row.relative = relativeVelocity(bodies, row, rigids, seconds);
    if (isNaN(row.relative)) return;
    const btScalar gap = contact.distance + leadOf(row, rigids, seconds);
    row.gapVelocity = std::max(seenGap(gap, row) / seconds, -pushingOut);
    warmStart(body, row.object->getWorldTransform(), seconds, row);
    rows_.push_back(row);
  };
  for (PointContact& contact : *body.bulletsContacts) add(contact);
  if (!own) return;
  for (PointContact& contact : own->pointContacts()) add(contact);
}

void ContactRows::addAnchors(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds) {
  assert(bodies.bodies()[index].elastic);
  const SolvedBody& body = bodies.bodies()[index];
  const auto& anchors = body.body->m_deformableAnchors;
  for (int k = 0; k < anchors.size(); ++k) {
    if (!(anchors[k].m_node->m_im > 0) || !anchors[k].m_cti.m_colObj) continue;
    ContactRow row;
    row.ends[0].body = index;
    row.ends[0].nodeCount = 1;
    row.ends[0].nodes[0] = indexIn(*body.body, anchors[k].m_node);
    row.ends[0].weights[0] = 1;
    row.joined = true;
    row.object = anchors[k].m_cti.m_colObj;
    row.normal.setValue(0, 1, 0);
    row.position = row.object->getWorldTransform() * anchors[k].m_local;
    row.ends[1].rigid = rigids.at(*row.object, row.position);
    row.offsetVelocity = (anchors[k].m_node->m_x - row.position) / seconds;
    row.relative = relativeVelocity(bodies, row, rigids, seconds);
    rows_.push_back(row);
  }
}

/// Nodes that several rows share get no stiffer than with one row.
void ContactRows::setStiffness(SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds) {
  std::vector<std::vector<btScalar>> loads(bodies.bodies().size());
  for (const ContactRow& row : rows_) {
    for (const RowEnd& end : row.ends) {
      if (row.joined || !end.isSoft()) continue;
      std::vector<btScalar>& load = loads[end.body];
      load.resize(bodies.bodies()[end.body].dynamics->nodeCount(), 0);
      for (std::uint32_t k = 0; k < end.nodeCount; ++k) {
        load[static_cast<std::size_t>(end.nodes[k])] += std::abs(end.weights[k]);
      }
    }
  }
  for (ContactRow& row : rows_) {
    if (row.constant) continue;
    btScalar fraction = 1;
    for (const RowEnd& end : row.ends) {
      for (std::uint32_t k = 0; k < end.nodeCount && !row.joined; ++k) {
        if (std::abs(end.weights[k]) < kSmallWeight) continue;
        fraction = std::max(fraction, loads[end.body][static_cast<std::size_t>(end.nodes[k])]);
      }
    }
    const double mass = effectiveMass(bodies, row, rigids);
    // A higher stiffness makes no visible difference, and the residual left by the solve would push with it.
    const double times = row.joined ? kAnchorStiffness : kStiffness * stiffening(bodies, row, seconds);
    const auto maximum = static_cast<btScalar>(times * mass) / fraction;
    row.stiffness = row.stiffness > 0 ? std::min(row.stiffness, maximum) : maximum;
    row.tangentStiffness = kTangentShare * row.stiffness;
    row.effectiveMass = static_cast<btScalar>(mass);
  }
}

void ContactRows::finish(SolverBodies& bodies, btScalar seconds) const {
  for (SolvedBody& body : bodies.bodies()) {
    body.frictionAnchors->clear();
    *body.hasRows = false;
  }
  for (const ContactRow& row : rows_) {
    if (row.contact) row.contact->impulse = row.impulse;
    if (row.joint) row.joint->impulse = row.impulse;
    if (row.state == ContactRow::State::Apart && !row.constant) continue;
    for (const RowEnd& end : row.ends) {
      if (end.isSoft()) *bodies.bodies()[end.body].hasRows = true;
    }
    if (!row.joined && row.ends[0].isSoft())
      bodies.bodies()[row.ends[0].body].frictionAnchors->push_back(frictionAnchorOf(row, seconds));
  }
  for (SolvedBody& body : bodies.bodies()) {
    std::stable_sort(body.frictionAnchors->begin(), body.frictionAnchors->end(),
                     [](const FrictionAnchor& a, const FrictionAnchor& b) { return a.point < b.point; });
  }
}

}  // namespace tetskin
