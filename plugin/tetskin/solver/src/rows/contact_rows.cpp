// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/contact_rows.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// D over effective masses: a gap is violated by a twentieth of the distance that the nodes alone would move. With
/// 0.01, a box of `tetskin_measure` (stop/equal steps/k50) stops 3 % too early.
constexpr double kStiffness = 20.0;
/// By how much of the body's size an impact may violate a gap: D is raised if a twentieth of the path towards the
/// object in this step is more than that. Otherwise fast bodies sink in by 5 % of their path, and tunnel through thin
/// walls.
constexpr double kViolation = 1e-3;
/// Upper bound of the factor by which D is raised for this: beyond it, the rounding of float dominates.
constexpr double kMostStiffening = 100.0;
/// The path that gravity adds in a step, times this, is left out: a small body at rest falls by a visible part of its
/// size in each step, and would jump on contacts stiffened for that.
constexpr btScalar kFallsAtRest = 2;
/// T over D. Slopes and stops in `tetskin_measure` also pass with 0.0003 and with 100, because the offset of a sticking
/// point grows until it suffices. But 100 takes 19 iterations per step in stop/equal steps/k50, where this value takes
/// 4.
constexpr btScalar kTangentShare = btScalar(0.3);
/// D of joints and anchors over effective masses, if the object is free to move (Joint) or not (Mount). What hangs on a
/// soft body is pushed by the residual of a solve, and more so with a higher D. A beam 16 times as long as thick that
/// sags by a thousandth of its length hangs lower by 1.5 % of that on its anchors; with 1000, by 8 %; with 1e5, slender
/// ones in float do not converge.
constexpr double kJointStiffness = 1000.0, kMountStiffness = 1e4;
/// Share by which each step moves the usual length of steps: with a tenth, bodies at rest move visibly under steps of 4
/// to 30 ms in random order; with a thousandth, following a change takes a minute.
constexpr double kFollowed = 0.01;
/// Largest factor by which an unusual step length makes contacts stiffer or softer: more would take many iterations.
constexpr double kMostOtherwise = 25.0;
/// Bound of the velocity at which penetrating bodies are pushed apart, in body sizes per second.
constexpr btScalar kPushingOut = 1;
/// Rounding of a position, in units of the last digit.
constexpr btScalar kPositionDigits = 2;
/// Smaller weights are ignored when rows share a node.
constexpr btScalar kSmallWeight = btScalar(0.02);
/// Cosine: contacts of one point whose normals differ by less than this angle count as the same contact in the next
/// step.
constexpr btScalar kSameNormal = btScalar(0.7);
/// Numbers of contacts that Bullet finds at faces begin here.
constexpr std::uint32_t kFirstFace = 0x80000000U;

std::array<double, 3> numbersOf(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

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

/// Rounding of a position, by axis: far from the origin, a depth of one last digit must not be pushed out.
btVector3 roundingOf(const btVector3& position) {
  return kPositionDigits * SIMD_EPSILON * position.absolute();
}

btScalar seenGap(btScalar gap, const PointContact& contact) {
  return gap < 0 ? std::min(gap + contact.normal.absolute().dot(roundingOf(contact.position)), btScalar(0)) : gap;
}

/// The offset without the components below the rounding.
btVector3 visibleOffset(const btVector3& offset, const btVector3& position) {
  const btVector3 rounding = roundingOf(position);
  btVector3 seen = offset;
  for (int k = 0; k < 3; ++k) {
    if (btFabs(offset[k]) <= rounding[k]) seen[k] = 0;
  }
  return seen;
}

/// The anchor that the last step stored for this contact, with the same sample or with another one of the point,
/// because samples may take turns; or null.
const FrictionAnchor* anchorFrom(const std::vector<FrictionAnchor>& anchors, const ContactRow& row,
                                 const RowOrigin& origin) {
  const auto less = [](const FrictionAnchor& a, const FrictionAnchor& b) { return a.point < b.point; };
  FrictionAnchor key;
  key.point = origin.point;
  const auto range = std::equal_range(anchors.begin(), anchors.end(), key, less);
  const FrictionAnchor* found = nullptr;
  for (auto known = range.first; known != range.second; ++known) {
    if (known->object != origin.object || known->normal.dot(row.normal) < kSameNormal) continue;
    if (known->sample == origin.sample) return &*known;
    if (!found) found = &*known;
  }
  return found;
}

/// Reads from the last step where the point sticks, and the impulse that acted on it.
/// remainder  of the point: see `remainderAt`
/// frame      the object's
void warmStart(const SolvedBody& body, const btVector3& remainder, const btTransform& frame, btScalar seconds,
               ContactRow& row, RowOrigin& origin) {
  assert(body.memory && seconds > 0);
  // In the object's frame, where sums keep digits that a position far from the origin lacks.
  const btVector3 here = frame.invXform(origin.position) + remainder * frame.getBasis();
  origin.stickingPosition = here;
  const FrictionAnchor* known = anchorFrom(body.memory->frictionAnchors, row, origin);
  if (!known) return;
  origin.stickingPosition = known->position;
  btVector3 offset = row.ends[1].isSoft() ? known->position : frame.getBasis() * (here - known->position);
  offset -= row.normal.dot(offset) * row.normal;
  const bool exact = body.elastic && !row.ends[1].isSoft() && origin.object->isStaticOrKinematicObject();
  row.offsetVelocity = (exact ? offset : visibleOffset(offset, origin.position)) / seconds;
  row.normalBound = known->normalForce * seconds;
  row.stuck = known->stuck;
}

/// Inverse effective mass of an end's point in a direction: that of its nodes alone, plus that of the rigid motion of
/// their component.
/// stiffer  factor of the stiffness of the nodes' neighbourhood
double compliance(const SolvedBody& body, const CarriedPoint& point, const btVector3& position,
                  const btVector3& direction, double stiffer) {
  assert(point.count > 0);
  double sum = 0.0;
  for (std::uint32_t k = 0; k < point.count; ++k) {
    btScalar inverse[6];
    body.dynamics->matrix().freeInverse(static_cast<std::size_t>(point.nodes[k]), inverse);
    auto own = static_cast<double>(direction.dot(symmetricMatrix(inverse) * direction));
    if (stiffer != 1.0 && own > 0.0) {
      const auto mass = static_cast<double>(body.dynamics->matrix().mass(static_cast<std::size_t>(point.nodes[k])));
      own = 1.0 / (mass + stiffer * std::max(1.0 / own - mass, 0.0));
    }
    sum += static_cast<double>(point.weights[k] * point.weights[k]) * own;
  }
  const auto node = static_cast<std::size_t>(point.nodes[0]);
  return sum +
         body.dynamics->rigidCompliance(body.dynamics->componentOf(node), numbersOf(position), numbersOf(direction));
}

/// By end: how much stiffer a soft body's matrix is in a step of this length; 1 for a rigid body.
std::array<double, 2> alphaRatios(const SolverBodies& bodies, const ContactRow& row, double seconds) {
  const auto ratio = [&](const RowEnd& end) {
    return end.isSoft() ? bodies.bodies()[end.body].dynamics->alphaRatio(seconds) : 1.0;
  };
  return {ratio(row.ends[0]), ratio(row.ends[1])};
}

/// stiffer  by end: see `compliance`
double effectiveMass(const SolverBodies& bodies, const ContactRow& row, const RowOrigin& origin,
                     const RigidUnknowns& rigids, const std::array<double, 2>& stiffer) {
  const auto along = [&](const btVector3& direction) {
    double sum = 0.0;
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = row.ends[e];
      sum += end.isSoft()
                 ? compliance(bodies.bodies()[end.body], origin.points[e], origin.position, direction, stiffer[e])
                 : rigids.compliance(end.rigid, direction);
    }
    return sum;
  };
  const double sum = row.joined ? (along({1, 0, 0}) + along({0, 1, 0}) + along({0, 0, 1})) / 3 : along(row.normal);
  return sum > 0.0 ? 1.0 / sum : 0.0;
}

/// The offset from the sticking position at the end of the step; for a sliding point, the offset that friction can
/// hold.
FrictionAnchor frictionAnchorOf(const ContactRow& row, const RowOrigin& origin, btScalar seconds) {
  assert(origin.object && seconds > 0);
  FrictionAnchor kept;
  kept.point = origin.point;
  kept.sample = origin.sample;
  kept.object = origin.object;
  kept.normal = row.normal;
  const btScalar along = row.normal.dot(row.impulse);
  kept.normalForce = along / seconds;
  kept.position = origin.stickingPosition;
  kept.stuck = row.state == ContactRow::State::Sticks;
  if (row.ends[1].isSoft()) kept.position = (row.slip + row.offsetVelocity) * seconds;
  if (row.state != ContactRow::State::Slides || !(row.tangentStiffness > 0)) return kept;
  const btVector3 reached = (row.slip + row.offsetVelocity) * seconds;
  const btVector3 held = -(row.impulse - along * row.normal) * (seconds / row.tangentStiffness);
  if (row.ends[1].isSoft()) {
    kept.position = held;
    return kept;
  }
  kept.position += origin.object->getWorldTransform().getBasis().transpose() * (reached - held);
  return kept;
}

/// The speed at which a point would penetrate the object, without what gravity adds in the step.
btScalar approach(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) {
  const btScalar falls = bodies.bodies()[row.ends[0].body].gravity.length() * seconds;
  return -row.normal.dot(row.relative) - row.gapVelocity - kFallsAtRest * falls;
}

/// The factor on a contact's D that keeps the violation of the gap invisible at this approach speed.
double stiffening(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) {
  assert(!row.joined && row.ends[0].isSoft());
  btScalar size = sizeOf(*bodies.bodies()[row.ends[0].body].body);
  if (row.ends[1].isSoft()) size = std::min(size, sizeOf(*bodies.bodies()[row.ends[1].body].body));
  const auto way = static_cast<double>(approach(bodies, row, seconds) * seconds);
  const double seen = kStiffness * kViolation * static_cast<double>(size);
  return way > seen ? std::min(way / seen, kMostStiffening) : 1.0;
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
    row.gapVelocity = std::max(seenGap(gap, contact) / seconds, -pushingOut);
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
    row.gapVelocity = std::max(seenGap(gap, contact) / seconds, -pushingOut);
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

/// False if the point is farther away than gravity moves it in a usual step, and does not come near.
bool ContactRows::mayTouch(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) const {
  const auto usual = static_cast<btScalar>(usualStep_);
  const btScalar near = kFallsAtRest * bodies.bodies()[row.ends[0].body].gravity.length() * usual * usual;
  return row.gapVelocity * seconds < near || approach(bodies, row, seconds) > 0;
}

void ContactRows::followStep(btScalar seconds) {
  const auto now = static_cast<double>(seconds);
  usualStep_ += (usualStep_ > 0.0 ? kFollowed : 1.0) * (now - usualStep_);
}

btScalar ContactRows::likeUsual(btScalar seconds) const {
  assert(usualStep_ > 0.0);
  const double steps = static_cast<double>(seconds) / usualStep_;
  return static_cast<btScalar>(std::min(std::max(steps * steps, 1.0 / kMostOtherwise), kMostOtherwise));
}

/// Counts touching rows, and others only if they are as near as in a step of usual length: longer steps have more of
/// them.
void ContactRows::listLoads(const SolverBodies& bodies, btScalar seconds) {
  loads_.resize(bodies.bodies().size());
  for (std::size_t b = 0; b < loads_.size(); ++b) {
    loads_[b].assign(bodies.bodies()[b].acted.rowCount > 0 ? bodies.bodies()[b].dynamics->nodeCount() : 0, 0);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ContactRow& row = rows_[r];
    if (row.joined || !row.ends[0].isSoft() || !mayTouch(bodies, row, seconds)) continue;
    for (std::size_t e = 0; e < 2; ++e) {
      if (!row.ends[e].isSoft()) continue;
      std::vector<btScalar>& load = loads_[row.ends[e].body];
      load.resize(bodies.bodies()[row.ends[e].body].dynamics->nodeCount(), 0);
      const CarriedPoint& point = origins_[r].points[e];
      for (std::uint32_t k = 0; k < point.count; ++k) {
        load[static_cast<std::size_t>(point.nodes[k])] += std::abs(point.weights[k]);
      }
    }
  }
}

/// The largest sum of weights at a node of the row, at least 1.
btScalar ContactRows::sharing(std::size_t row) const {
  btScalar most = 1;
  for (std::size_t e = 0; e < 2 && !rows_[row].joined; ++e) {
    if (!rows_[row].ends[e].isSoft()) continue;
    const std::vector<btScalar>& load = loads_[rows_[row].ends[e].body];
    const CarriedPoint& point = origins_[row].points[e];
    for (std::uint32_t k = 0; k < point.count && !load.empty(); ++k) {
      if (std::abs(point.weights[k]) < kSmallWeight) continue;
      most = std::max(most, load[static_cast<std::size_t>(point.nodes[k])]);
    }
  }
  return most;
}

/// A node shared by several rows gets no stiffer than with one row.
void ContactRows::setStiffness(const SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds) {
  followStep(seconds);
  listLoads(bodies, seconds);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    ContactRow& row = rows_[r];
    if (row.constant) continue;
    const std::array<double, 2> asIs = {1.0, 1.0}, asUsual = alphaRatios(bodies, row, usualStep_);
    const double mass = effectiveMass(bodies, row, origins_[r], rigids, asIs);
    const double usualMass = asUsual == asIs ? mass : effectiveMass(bodies, row, origins_[r], rigids, asUsual);
    // A higher stiffness makes no visible difference, and would amplify the residual of the solve.
    const bool mounted = !row.ends[1].isSoft() && row.ends[1].rigid.unknown < 0;
    const double times = !row.joined ? kStiffness * stiffening(bodies, row, seconds)
                         : mounted   ? kMountStiffness
                                     : kJointStiffness;
    const auto maximum = static_cast<btScalar>(times * usualMass) * likeUsual(seconds) / sharing(r);
    row.stiffness = row.stiffness > 0 ? std::min(row.stiffness, maximum) : maximum;
    row.tangentStiffness = kTangentShare * row.stiffness;
    row.effectiveMass = static_cast<btScalar>(mass);
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
