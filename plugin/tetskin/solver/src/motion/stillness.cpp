// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/motion/stillness.h>

#include <algorithm>
#include <cassert>
#include <iterator>

namespace tetskin::bullet_detail {
namespace {

/// Bullet's threshold of sleep is a speed, 0.04 unless the application sets it. It is taken to be that of a body of
/// size 1 under this gravity; for other bodies it scales with sqrt(gravity x size).
constexpr btScalar kGravityOfThreshold = btScalar(9.81);
/// Minimum of the speed unit, in sizes per second, for low gravity.
constexpr btScalar kSizesPerSecond = btScalar(0.1);
/// Bound of a point's way while the body waits, in body sizes, at a threshold of 1: a body that sways by less stays
/// where it is for all that can be seen.
constexpr btScalar kSway = btScalar(0.5);
/// A body that sways comes back to less than this part of its way, again and again: one that drifts never does.
constexpr btScalar kBack = btScalar(0.5);
/// Bound of the drift of a body that is still, in body sizes per second, at a threshold of 1.
constexpr btScalar kDrift = btScalar(0.0125);
/// Largest acceleration of a body that falls asleep, as a fraction of gravity, at a threshold of 1: its forces stay as
/// they are from then on, and should add up to its weight. A mean over time, because residuals of single steps' solves
/// are larger: over this fraction of the time in which gravity moves the body by its own size.
constexpr btScalar kUnbalanced = btScalar(0.025), kMeanTime = btScalar(0.3);
/// The same across gravity, as a multiple, where something sticks: friction and joints could hold as much.
constexpr btScalar kHeld = 5;
/// Fraction of the sleep threshold that points must be below when a body falls asleep: faster ones still swing, and
/// load one support after the other.
constexpr btScalar kCalm = btScalar(0.2);
/// Bullet's thresholds of rigid bodies (0.8 unless the application sets it) over those of soft ones.
constexpr btScalar kRigidThreshold = 20;
/// Rounding of positions, in units of the last digit: far from the origin, nodes at rest occasionally jump by one, and
/// contact forces jump with them.
constexpr btScalar kLastDigits = 4;

btVector3 gravityOf(const SolvedBody& solved) {
  return solved.elastic ? solved.gravity : solved.body->getWorldInfo()->m_gravity;
}

bool isPinned(const btSoftBody& body) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (body.m_nodes[n].m_im == 0) return true;
  }
  return false;
}

/// True if anything keeps the body from flying freely; contacts of Bullet's own bodies are not known here.
bool isHeld(const SolvedBody& solved) {
  return !solved.elastic || solved.memory->rows.any || isPinned(*solved.body);
}

/// The velocity of the centroid of the nodes that can move.
btVector3 meanVelocity(const btSoftBody& body) {
  btVector3 momentum(0, 0, 0);
  btScalar mass = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    if (!(node.m_im > 0)) continue;
    momentum += node.m_v / node.m_im;
    mass += 1 / node.m_im;
  }
  return mass > 0 ? momentum / mass : momentum;
}

/// The unit of speed for a body of this size.
btScalar unitOf(btScalar size, btScalar gravity) {
  return std::max(btSqrt(gravity * size / kGravityOfThreshold), kSizesPerSecond * size);
}

bool isSlow(btScalar squaredSpeed, btScalar unit, btScalar squaredThreshold) {
  return squaredSpeed / (unit * unit) < squaredThreshold;
}

/// An object that has waited long enough by Bullet's count, but not by ours, must wait on.
void setTime(btCollisionObject& object, btScalar time) {
  if (time != object.getDeactivationTime()) object.setDeactivationTime(time);
  const bool waits = object.getActivationState() == WANTS_DEACTIVATION && !(time > gDeactivationTime);
  if (waits) object.setActivationState(ACTIVE_TAG);
}

bool mayNotSleep(const btCollisionObject& object) {
  return object.getActivationState() == DISABLE_DEACTIVATION;
}

/// What rows hold by friction or as joints.
struct Held {
  std::vector<bool> bodies, rigids;
};

Held heldBy(SolverBodies& bodies, const RigidUnknowns& rigids) {
  Held held{std::vector<bool>(bodies.bodies().size()), std::vector<bool>(rigids.list().size())};
  for (const SolvedSystem& system : bodies.systems()) {
    for (const ContactRow* row : system.rows) {
      if (!row->joined && row->state != ContactRow::State::Sticks) continue;
      for (const RowEnd& end : row->ends) {
        if (end.isSoft()) held.bodies[end.body] = true;
        if (!end.isSoft() && end.rigid.unknown >= 0) held.rigids[static_cast<std::size_t>(end.rigid.unknown)] = true;
      }
    }
  }
  return held;
}

}  // namespace

std::vector<btSoftBody*> Stillness::fallAsleep(const std::vector<btDiscreteDynamicsWorld*>& worlds) {
  std::vector<btSoftBody*> asleep;
  for (btDiscreteDynamicsWorld* world : worlds) sleepByIslands(world->getCollisionObjectArray(), asleep);
  return asleep;
}

/// The islands are those of the last step. A soft body that has to wait for others must not be put to sleep by Bullet
/// either, should its island differ in this step.
void Stillness::sleepByIslands(const btCollisionObjectArray& objects, std::vector<btSoftBody*>& asleep) {
  std::unordered_map<int, bool> awake;  // by island with a soft body that has waited long enough
  for (int k = 0; k < objects.size(); ++k) {
    const btSoftBody* body = btSoftBody::upcast(objects[k]);
    if (!body || body->getActivationState() != WANTS_DEACTIVATION) continue;
    if (isDisturbed(*body)) setTime(*objects[k], 0);
    awake[body->getIslandTag()] = false;
  }
  if (awake.empty()) return;
  const auto islandOf = [&](const btCollisionObject& object) {
    return object.isStaticOrKinematicObject() ? awake.end() : awake.find(object.getIslandTag());
  };
  for (int k = 0; k < objects.size(); ++k) {
    const int state = objects[k]->getActivationState();
    const auto island = islandOf(*objects[k]);
    if (island != awake.end()) island->second |= state == ACTIVE_TAG || state == DISABLE_DEACTIVATION;
  }
  for (int k = 0; k < objects.size(); ++k) {
    const auto island = islandOf(*objects[k]);
    if (island == awake.end() || objects[k]->getActivationState() != WANTS_DEACTIVATION) continue;
    btSoftBody* body = btSoftBody::upcast(objects[k]);
    if (!island->second) objects[k]->setActivationState(ISLAND_SLEEPING);
    if (island->second && body) objects[k]->setActivationState(ACTIVE_TAG);
    if (!island->second && body) asleep.push_back(body);
  }
}

/// True if the application has moved the body, or given it a velocity or other masses, since the last step.
bool Stillness::isDisturbed(const btSoftBody& body) const {
  const auto found = waits_.find(&body);
  if (found == waits_.end() || body.m_bUpdateRtCst) return true;
  const Wait& wait = found->second;
  if (wait.newer.points.size() != static_cast<std::size_t>(body.m_nodes.size())) return true;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    const btVector3 way = node.m_x - wait.newer.points[static_cast<std::size_t>(n)];
    if (node.m_v.length2() > wait.speed * wait.speed) return true;
    if (way.length2() > wait.displacement * wait.displacement) return true;
  }
  return false;
}

void Stillness::judge(SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds) {
  assert(seconds > 0);
  ++step_;
  const Held held = heldBy(bodies, rigids);
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) judge(bodies.bodies()[b], held.bodies[b], seconds);
  std::vector<btCollisionObject*> members;
  for (const SolvedSystem& system : bodies.systems()) {
    members.clear();
    for (const std::size_t b : system.bodies) members.push_back(bodies.bodies()[b].body);
    for (const std::size_t r : system.rigids) {
      btRigidBody* rigid = rigids.list()[r].rigid;
      if (!rigid || !rigid->isActive()) continue;  // Bullet, whose islands are others, may have put it to sleep
      judge(*rigid, held.rigids[r], seconds);
      members.push_back(rigid);
    }
    waitForEachOther(members, seconds);
  }
  for (auto wait = waits_.begin(); wait != waits_.end();) {
    wait = wait->second.step == step_ ? std::next(wait) : waits_.erase(wait);
  }
}

void Stillness::judge(SolvedBody& solved, bool sticks, btScalar seconds) {
  btSoftBody& body = *solved.body;
  if (mayNotSleep(body)) return;
  motion_.points.clear();
  motion_.size = sizeOf(body);
  motion_.gravity = gravityOf(solved);
  motion_.threshold = body.m_sleepingThreshold;
  motion_.squaredSpeed = body.m_maxSpeedSquared;
  motion_.far = (body.m_bounds[0].absolute() + body.m_bounds[1].absolute()).length();
  motion_.touched = !solved.elastic || solved.memory->rows.contacts;
  motion_.sticks = sticks || isPinned(body);
  const bool flies = body.m_maxSpeedSquared > 0 && !isHeld(solved);
  const btScalar bullets = motion_.threshold * motion_.threshold;
  const auto mayWait = [&] {
    if (flies || !isSlow(motion_.squaredSpeed, unitOf(motion_.size, motion_.gravity.length()), bullets)) return false;
    for (int n = 0; n < body.m_nodes.size(); ++n) motion_.points.push_back(body.m_nodes[n].m_x);
    motion_.velocity = meanVelocity(body);
    return waits(body, motion_, seconds);
  };
  const bool waiting = mayWait();
  btScalar& speed = body.m_maxSpeedSquared;
  speed = waiting ? std::min(speed, bullets / 2) : std::max(speed, bullets);
  if (!waiting) setTime(body, 0);
}

/// Bullet's own count goes on: whoever does not rest by ours may still do so by Bullet's.
void Stillness::judge(btRigidBody& rigid, bool sticks, btScalar seconds) {
  if (mayNotSleep(rigid)) return;
  const btTransform& place = rigid.getCenterOfMassTransform();
  btVector3 low, high;
  rigid.getCollisionShape()->getAabb(btTransform::getIdentity(), low, high);
  motion_.size = (high - low)[(high - low).maxAxis()];
  motion_.points.assign(1, place.getOrigin());
  for (int axis = 0; axis < 3; ++axis) {
    motion_.points.push_back(place.getOrigin() + place.getBasis().getColumn(axis) * (motion_.size / 2));
  }
  motion_.velocity = rigid.getLinearVelocity();
  motion_.gravity = rigid.getGravity();
  motion_.threshold = rigid.getLinearSleepingThreshold() / kRigidThreshold;
  const btScalar speed = motion_.velocity.length() + rigid.getAngularVelocity().length() * motion_.size / 2;
  motion_.squaredSpeed = speed * speed;
  motion_.far = place.getOrigin().length() + motion_.size;
  motion_.touched = true;
  motion_.sticks = sticks;
  const btScalar unit = unitOf(motion_.size, motion_.gravity.length());
  if (isSlow(motion_.squaredSpeed, unit, motion_.threshold * motion_.threshold)) waits(rigid, motion_, seconds);
}

/// For a body that is slow. Returns false if it has to begin to wait anew.
bool Stillness::waits(const btCollisionObject& object, const Motion& motion, btScalar seconds) {
  const btScalar size = motion.size, threshold = motion.threshold, gravity = motion.gravity.length();
  const btScalar unit = unitOf(size, gravity), rounding = kLastDigits * SIMD_EPSILON * motion.far;
  Wait& wait = waits_[&object];
  wait.step = step_;
  wait.rests = false;
  const bool begins = wait.newer.points.size() != motion.points.size() || !(object.getDeactivationTime() > wait.clock);
  const btScalar farthest = kSway * threshold * size + rounding;
  btScalar way = begins ? btScalar(0) : wayFrom(wait.older, motion.points);
  btScalar moved = begins ? btScalar(0) : wayFrom(wait.newer, motion.points);
  if (way > farthest && !(moved > farthest)) {
    wait.older = wait.newer;
    way = moved;
  }
  if (begins || way > farthest) {
    wait.still = wait.older = wait.newer = {motion.points, 0, 0, 0};
    wait.balanced = 0;
    if (!begins) return false;
  }
  const btScalar drift = kDrift * threshold * size * sleepAfter + rounding;
  if (wayFrom(wait.still, motion.points) > drift) wait.still = {motion.points, 0, 0, 0};
  const btScalar half = seconds / 2;
  const bool isStill = !(wait.still.seconds + half < sleepAfter);
  const bool sways = motion.sticks && !(wait.older.seconds + half < sleepAfter) && !(way > wait.older.returned);
  const bool isCalm = isSlow(motion.squaredSpeed, unit, kCalm * kCalm * threshold * threshold);
  wait.rests = isBalanced(motion, rounding, seconds, wait) && isCalm && (isStill || sways);
  wait.speed = threshold * unit + rounding / seconds;
  for (Past* past : {&wait.still, &wait.older, &wait.newer}) past->seconds += seconds;
  if (!(wait.newer.seconds < sleepAfter)) {
    // While a body sways as it is known to do, its past stays: others that it waits for sway in their own time.
    if (way > wait.older.returned) wait.older = std::move(wait.newer);
    wait.newer = {motion.points, 0, 0, 0};
    moved = 0;
  }
  wait.displacement = moved + kCalm * threshold * unit * seconds + drift;
  return true;
}

/// True if the forces on the body balance. Those along gravity must have done so for as long as the body waits: where a
/// swinging stack turns, its velocity has no mean, but it weighs too much or too little.
bool Stillness::isBalanced(const Motion& motion, btScalar rounding, btScalar seconds, Wait& wait) const {
  const btScalar gravity = motion.gravity.length();
  const btScalar time =
      kMeanTime * btSqrt(motion.size / std::max(gravity, kSizesPerSecond * kSizesPerSecond * motion.size));
  wait.velocity += std::min(seconds / time, btScalar(1)) * (motion.velocity - wait.velocity);
  if (!(gravity > 0)) return true;
  const btVector3 off = motion.velocity - wait.velocity;
  const btScalar along = btFabs(off.dot(motion.gravity)) / gravity;
  const btScalar allowed =
      kUnbalanced * motion.threshold * gravity * time + (motion.touched ? rounding / seconds : btScalar(0));
  wait.balanced = along > allowed ? btScalar(0) : wait.balanced + seconds;
  const bool lasts = !(wait.balanced < sleepAfter);
  return lasts && !(off.length() > (motion.sticks ? kHeld : btScalar(1)) * allowed);
}

btScalar Stillness::wayFrom(Past& past, const std::vector<btVector3>& points) {
  btScalar squared = 0;
  for (std::size_t k = 0; k < points.size(); ++k) squared = std::max(squared, (points[k] - past.points[k]).length2());
  const btScalar way = btSqrt(squared);
  past.farthest = std::max(past.farthest, way);
  if (way < kBack * past.farthest) past.returned = past.farthest;
  return way;
}

bool Stillness::rests(const btCollisionObject& object) const {
  const auto found = waits_.find(&object);
  return found != waits_.end() && found->second.step == step_ && found->second.rests;
}

/// They fall asleep together. Each is as long still as the one that has been still for the shortest time. Bullet's
/// islands do not know contacts of soft bodies, nor joints. Multibodies have their own timer.
void Stillness::waitForEachOther(const std::vector<btCollisionObject*>& members, btScalar seconds) {
  bool all = gDeactivationTime > 0 && !gDisableDeactivation, softs = all;
  btScalar shortest = BT_LARGE_FLOAT;
  for (const btCollisionObject* member : members) {
    const bool resting = !mayNotSleep(*member) && rests(*member);
    shortest = std::min(shortest, mayNotSleep(*member) ? btScalar(0) : member->getDeactivationTime());
    all &= resting;
    softs &= resting || btRigidBody::upcast(member) != nullptr;
  }
  // By Bullet's count, too, soft bodies wait for their turn.
  if (!softs) shortest = std::min(shortest, std::max(gDeactivationTime - 2 * seconds, btScalar(0)));
  for (btCollisionObject* member : members) {
    setTime(*member, std::min(shortest, member->getDeactivationTime()));
    if (const auto wait = waits_.find(member); wait != waits_.end()) wait->second.clock = member->getDeactivationTime();
    if (all && member->getActivationState() == ACTIVE_TAG) member->setActivationState(WANTS_DEACTIVATION);
  }
}

void Stillness::shift(const btVector3& by) {
  for (auto& [body, wait] : waits_) {
    for (Past* past : {&wait.still, &wait.older, &wait.newer}) {
      for (btVector3& point : past->points) point += by;
    }
  }
}

/// All of them have waited in the last step.
void Stillness::serialize(WorldStream& stream) {
  stream(sleepAfter);
  stream.byObject(waits_, [&](const btCollisionObject&, Wait& wait) {
    for (Past* past : {&wait.still, &wait.older, &wait.newer}) {
      stream.each(past->points, [&](btVector3& point) { stream(point); });
      stream(past->seconds, past->farthest, past->returned);
    }
    stream(wait.velocity, wait.balanced, wait.clock, wait.displacement, wait.speed, wait.rests);
    if (stream.restoring()) wait.step = step_;
  });
}

}  // namespace tetskin::bullet_detail
