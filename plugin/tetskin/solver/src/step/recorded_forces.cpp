// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btIDebugDraw.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/step/recorded_forces.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::bullet_detail {
namespace {

/// In a world without gravity, arrows are as long as under this one.
constexpr btScalar kEarthsGravity = btScalar(9.81);

/// Gives access to protected members of a base class.
struct WorldMembers : btDeformableMultiBodyDynamicsWorld {
  static btScalar& fixedTimeStep(btDeformableMultiBodyDynamicsWorld& world) {
    return world.*(&WorldMembers::m_fixedTimeStep);
  }
  static bool has(btDeformableMultiBodyDynamicsWorld& world, btActionInterface* action) {
    const auto& actions = world.*(&WorldMembers::m_actions);
    return actions.findLinearSearch(action) < actions.size();
  }
};

int idInWorld(const btCollisionObject& object) {
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  return proxy ? proxy->m_uniqueId : 0;
}

void addScaled(btScalar factor, const AppliedForces& from, AppliedForces& to) {
  const auto add = [&](const Wrench& wrench, Wrench& sum) {
    sum.force += factor * wrench.force;
    sum.torque += factor * wrench.torque;
  };
  add(from.contact, to.contact);
  add(from.friction, to.friction);
  add(from.joints, to.joints);
  add(from.anchors, to.anchors);
}

void addImpulse(const btVector3& impulse, const btVector3& arm, Wrench& to) {
  to.force += impulse;
  to.torque += arm.cross(impulse);
}

/// Adds the impulse of a row at one of its ends.
/// isJoint  a joined row is a joint rather than an anchor
/// sign     of the row's impulse there
void addRow(const ContactRow& row, bool isJoint, btScalar sign, const btVector3& arm, AppliedForces& to) {
  if (row.joined) return addImpulse(sign * row.impulse, arm, isJoint ? to.joints : to.anchors);
  const btVector3 along = row.normal.dot(row.impulse) * row.normal;
  addImpulse(sign * along, arm, to.contact);
  addImpulse(sign * (row.impulse - along), arm, to.friction);
}

bool isNothing(const AppliedForces& forces) {
  for (const Wrench& wrench : {forces.contact, forces.friction, forces.joints, forces.anchors}) {
    if (!wrench.force.isZero() || !wrench.torque.isZero()) return false;
  }
  return true;
}

/// True if a soft participant is awake; at least one participant is soft.
template <class Participants>
bool isAnyAwake(const SolverBodies& bodies, const Participants& participants) {
  return std::any_of(participants.begin(), participants.end(), [&](const auto& participant) {
    return participant.soft && bodies.indexOf(participant.soft) < bodies.bodies().size();
  });
}

}  // namespace

// ---- a substep

void RecordedForces::record(const SolverBodies& bodies, const ContactRows& rows, const std::vector<GivenImpulse>& given,
                            btScalar seconds) {
  assert(seconds > 0);
  if (stepBegins()) beginStep();
  seconds_ += seconds;
  for (Pair& pair : pairs_) {
    pair.sleeps = !isAnyAwake(bodies, pair.participants);
    if (pair.sleeps) pair.asleep += seconds;
  }
  points_.erase(std::remove_if(points_.begin(), points_.end(),
                               [&](const Point& point) { return isAnyAwake(bodies, point.participants); }),
                points_.end());
  weights_.clear();
  for (const ContactRow& row : rows.rows()) {
    if (row.ends[0].isSoft() && !row.impulse.isZero()) add(bodies, row, rows.originOf(row), seconds);
  }
  for (const GivenImpulse& one : given) add(one);
}

/// Bullet does not report the beginning of a stepSimulation. But it sets m_fixedTimeStep there, and reads it only for
/// the motion states of rigid bodies. This function changes it by one last digit, 5e-10 s for a 240th of a second, and
/// the change is still there in the following substeps. It is 0 if a stepSimulation has one substep, of any length.
bool RecordedForces::stepBegins() {
  btScalar& length = WorldMembers::fixedTimeStep(world_);
  if (length == 0) return true;
  if (length == mark_) return false;
  mark_ = length = std::nextafter(length, std::numeric_limits<btScalar>::max());
  return true;
}

void RecordedForces::beginStep() {
  for (Pair& pair : pairs_) {
    pair.before = {forcesOf(pair, 0), forcesOf(pair, 1)};
    pair.impulses = {};
    pair.asleep = 0;
  }
  secondsBefore_ = seconds_;
  seconds_ = 0;
  dropRemoved();
}

/// Drops contacts that have ended, and objects that have been removed. The latter only cost memory, so they are looked
/// for only when the number of objects in the world has changed.
void RecordedForces::dropRemoved() {
  const bool anyRemoved = objectCount_ != world_.getNumCollisionObjects();
  objectCount_ = world_.getNumCollisionObjects();
  const auto goes = [&](const Pair& pair) {
    const auto& [first, second] = pair.participants;
    return (isNothing(pair.before[0]) && isNothing(pair.before[1])) ||
           (anyRemoved && !(isPresent(first) && isPresent(second)));
  };
  const auto last = std::remove_if(pairs_.begin(), pairs_.end(), goes);
  if (last == pairs_.end()) return;
  pairs_.erase(last, pairs_.end());
  listPairs();
}

void RecordedForces::listPairs() {
  indices_.clear();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto& [first, second] = pairs_[k].participants;
    indices_[{first.object, second.object}] = k;
  }
}

void RecordedForces::add(const SolverBodies& bodies, const ContactRow& row, const RowOrigin& origin, btScalar seconds) {
  const btSoftBody& body = *bodies.bodies()[row.ends[0].body].body;
  if (origin.object == &body) return;
  Participants participants;
  participants[0] = {&body, &body, idInWorld(body)};
  if (origin.object) participants[1] = {origin.object, btSoftBody::upcast(origin.object), idInWorld(*origin.object)};
  Pair& pair = pairOf(participants);
  const bool turned = pair.participants[0].object != &body;
  for (std::size_t e = 0; e < 2; ++e) {
    if (!participants[e].object) continue;
    const btVector3 arm = armOf(origin.points[e], participants[e], origin.position);
    addRow(row, origin.joint != nullptr, btScalar(signOf(e)), arm, pair.impulses[turned ? 1 - e : e]);
  }
  if (!row.joined && world_.getDebugDrawer()) {
    points_.push_back({participants, origin.position, row.normal, arrowOf(row.impulse / seconds, body)});
  }
}

void RecordedForces::add(const GivenImpulse& given) {
  Participants participants;
  for (std::size_t e = 0; e < 2; ++e) {
    const btCollisionObject* object = e == 0 ? given.pair.body : given.pair.object;
    participants[e] = {object, btSoftBody::upcast(object), idInWorld(*object)};
  }
  if (participants[0].object == participants[1].object) return;
  Pair& pair = pairOf(participants);
  const bool turned = pair.participants[0].object != participants[0].object;
  for (std::size_t e = 0; e < 2; ++e) {
    const btSoftBody* soft = participants[e].soft;
    const btVector3 about = soft ? weightOf(*soft).centroid : participants[e].object->getWorldTransform().getOrigin();
    addImpulse(btScalar(signOf(e)) * given.impulse, given.at - about, pair.impulses[turned ? 1 - e : e].contact);
  }
}

/// The pair of two participants, in either order.
RecordedForces::Pair& RecordedForces::pairOf(const Participants& participants) {
  const auto& [first, second] = participants;
  auto entry = indices_.find({first.object, second.object});
  if (entry == indices_.end()) entry = indices_.find({second.object, first.object});
  if (entry == indices_.end()) {
    entry = indices_.emplace(std::make_pair(first.object, second.object), pairs_.size()).first;
    pairs_.emplace_back().participants = participants;
  }
  assert(entry->second < pairs_.size());
  Pair& pair = pairs_[entry->second];
  const std::size_t own = pair.participants[0].object == first.object ? 0 : 1;
  const bool same = pair.participants[own].id == first.id && pair.participants[1 - own].id == second.id;
  if (!same) {
    pair = Pair();
    pair.participants[own] = first;
    pair.participants[1 - own] = second;
  }
  return pair;
}

// ---- points of application

btVector3 RecordedForces::armOf(const CarriedPoint& point, const Participant& participant, const btVector3& position) {
  if (!participant.soft) return position - participant.object->getWorldTransform().getOrigin();
  const btVector3& centroid = weightOf(*participant.soft).centroid;
  return point.sum([&](int n) { return participant.soft->m_nodes[n].m_x - centroid; });
}

/// Pinned nodes have no moving mass; if all nodes of a body are pinned, each has the same weight.
const RecordedForces::Weight& RecordedForces::weightOf(const btSoftBody& body) {
  const auto [entry, isNew] = weights_.emplace(&body, Weight());
  Weight& weight = entry->second;
  if (!isNew) return weight;
  btVector3 sum(0, 0, 0), any(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    any += node.m_x;
    if (!(node.m_im > 0)) continue;
    sum += node.m_x / node.m_im;
    weight.mass += 1 / node.m_im;
  }
  weight.centroid = weight.mass > 0 ? sum / weight.mass : any / btScalar(body.m_nodes.size());
  return weight;
}

// ---- queries

AppliedForces RecordedForces::on(const btCollisionObject& object, const btCollisionObject* other) const {
  AppliedForces sum;
  const int id = idInWorld(object);
  for (const Pair& pair : pairs_) {
    for (std::size_t side = 0; side < 2; ++side) {
      const Participant &own = pair.participants[side], &from = pair.participants[1 - side];
      if (own.object != &object || own.id != id) continue;
      if ((other && from.object != other) || !isPresent(from)) continue;
      addScaled(1, forcesOf(pair, side), sum);
    }
  }
  return sum;
}

AppliedForces RecordedForces::forcesOf(const Pair& pair, std::size_t side) const {
  const btScalar awake = seconds_ - pair.asleep;
  if (!(awake > 0)) return pair.before[side];
  // The stepSimulation in which bodies fall asleep has fewer substeps with them. A single substep is not exact: the
  // next one makes up for what its solve leaves out. As the bodies rest, those of the last stepSimulation count, too.
  const btScalar before = pair.sleeps && !isNothing(pair.before[side]) ? secondsBefore_ : btScalar(0);
  AppliedForces forces;
  addScaled(1 / (awake + before), pair.impulses[side], forces);
  addScaled(before / (awake + before), pair.before[side], forces);
  return forces;
}

/// An object that is not in the world may have been destroyed: only its address is compared.
bool RecordedForces::isPresent(const Participant& participant) const {
  if (!participant.object) return true;
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  const int index = objects.findLinearSearch(const_cast<btCollisionObject*>(participant.object));
  return index < objects.size() && idInWorld(*objects[index]) == participant.id;
}

// ---- snapshots

void serialize(WorldStream& stream, std::array<AppliedForces, 2>& ofPair) {
  for (AppliedForces& forces : ofPair) {
    for (Wrench* wrench : {&forces.contact, &forces.friction, &forces.joints, &forces.anchors}) {
      stream(wrench->force, wrench->torque);
    }
  }
}

void RecordedForces::clear() {
  mark_ = seconds_ = secondsBefore_ = 0;
  pairs_.clear();
  indices_.clear();
  points_.clear();
}

/// Only pairs whose objects are in the world: others are not reported.
void RecordedForces::serialize(WorldStream& stream) {
  stream(mark_, seconds_, secondsBefore_);
  std::vector<Pair> present;
  for (const Pair& pair : pairs_) {
    if (isPresent(pair.participants[0]) && isPresent(pair.participants[1])) present.push_back(pair);
  }
  stream.each(present, [&](Pair& pair) {
    for (Participant& participant : pair.participants) {
      bool isObject = participant.object != nullptr;
      stream(isObject);
      stream.object(participant.object);
      if (isObject != (participant.object != nullptr)) stream.fail();
      participant.soft = participant.object ? btSoftBody::upcast(participant.object) : nullptr;
      participant.id = participant.object ? idInWorld(*participant.object) : 0;
    }
    bullet_detail::serialize(stream, pair.impulses);
    bullet_detail::serialize(stream, pair.before);
    stream(pair.asleep, pair.sleeps);
  });
  if (!stream.restoring()) return;
  pairs_ = std::move(present);
  listPairs();
  points_.clear();
}

// ---- drawing

/// The length of the arrow of a force: a force as large as the body's weight is as long as the body.
btVector3 RecordedForces::arrowOf(const btVector3& force, const btSoftBody& body) {
  const btScalar gravity = world_.getGravity().length(), mass = weightOf(body).mass;
  const btScalar weight = mass * (gravity > 0 ? gravity : kEarthsGravity);
  return weight > 0 ? force * (sizeOf(body) / weight) : btVector3(0, 0, 0);
}

void RecordDrawing::draw(std::weak_ptr<RecordedForces> recorded, btDeformableMultiBodyDynamicsWorld& world) {
  recorded_ = std::move(recorded);
  if (!WorldMembers::has(world, this)) world.addAction(this);
}

void RecordDrawing::debugDraw(btIDebugDraw* drawer) {
  if (!drawer || !(drawer->getDebugMode() & btIDebugDraw::DBG_DrawContactPoints)) return;
  if (const auto recorded = recorded_.lock()) recorded->debugDraw(*drawer);
}

void RecordedForces::debugDraw(btIDebugDraw& drawer) const {
  const btIDebugDraw::DefaultColors colors = drawer.getDefaultColors();
  for (const Point& point : points_) {
    if (!isPresent(point.participants[0]) || !isPresent(point.participants[1])) continue;
    drawer.drawContactPoint(point.position, point.normal, 0, 0, colors.m_contactPoint);
    drawer.drawLine(point.position, point.position + point.arrow, colors.m_contactPoint);
  }
}

}  // namespace tetskin::bullet_detail
