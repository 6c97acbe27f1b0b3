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
/// Bound of a node's displacement while the body waits, in body sizes, at a threshold of 1.
constexpr btScalar kDisplacement = btScalar(0.025);
/// Largest acceleration of a body that falls asleep, as a fraction of gravity, at a threshold of 1: its forces stay as
/// they are from then on, and should add up to its weight. A mean over time, because residuals of single steps' solves
/// are larger: over this fraction of the time in which gravity moves the body by its own size.
constexpr btScalar kUnbalanced = btScalar(0.025), kMeanTime = btScalar(0.3);
/// Fraction of the sleep threshold that nodes must be below when a body falls asleep: faster ones still swing, and load
/// one support after the other.
constexpr btScalar kCalm = btScalar(0.1);
/// Rounding of positions, in units of the last digit: far from the origin, nodes at rest occasionally jump by one, and
/// contact forces jump with them.
constexpr btScalar kLastDigits = 4;

btScalar gravityOf(const SolvedBody& solved) {
  return solved.elastic ? solved.elastic->world->getGravity().length()
                        : solved.body->getWorldInfo()->m_gravity.length();
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

/// An object that has waited long enough by Bullet's count, but not by ours, must wait on.
void setTime(btCollisionObject& object, btScalar time) {
  if (time == object.getDeactivationTime()) return;
  object.setDeactivationTime(time);
  if (object.getActivationState() == WANTS_DEACTIVATION) object.setActivationState(ACTIVE_TAG);
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
bool Stillness::isDisturbed(const btSoftBody& body) {
  const auto found = waits_.find(&body);
  if (found == waits_.end() || body.m_bUpdateRtCst) return true;
  const btScalar speed = found->second.speed;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (body.m_nodes[n].m_v.length2() > speed * speed) return true;
  }
  return wasDisplaced(body, found->second);
}

void Stillness::judge(SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds) {
  assert(seconds > 0);
  ++step_;
  for (SolvedBody& solved : bodies.bodies()) {
    btSoftBody& body = *solved.body;
    if (body.getActivationState() == DISABLE_DEACTIVATION) continue;
    const btScalar time = timeOf(solved, seconds), bullets = body.m_sleepingThreshold * body.m_sleepingThreshold;
    btScalar& speed = body.m_maxSpeedSquared;
    speed = time < 0 ? std::max(speed, bullets) : std::min(speed, bullets / 2);
    setTime(body, std::max(time, btScalar(0)));
  }
  for (const SolvedSystem& system : bodies.systems()) {
    if (system.bodies.size() + system.rigids.size() > 1) waitForEachOther(bodies, system, rigids);
  }
  for (auto wait = waits_.begin(); wait != waits_.end();) {
    wait = wait->second.step == step_ ? std::next(wait) : waits_.erase(wait);
  }
}

/// The time for which the body has been still: below 0 if it moves, and below Bullet's limit if it is not yet calm.
btScalar Stillness::timeOf(const SolvedBody& solved, btScalar seconds) {
  const btSoftBody& body = *solved.body;
  const btScalar size = sizeOf(body), gravity = gravityOf(solved), threshold = body.m_sleepingThreshold;
  const btScalar unit = std::max(btSqrt(gravity * size / kGravityOfThreshold), kSizesPerSecond * size);
  const btScalar squared = body.m_maxSpeedSquared / (unit * unit);
  if (!(squared < threshold * threshold)) return -1;
  if (squared > 0 && !isHeld(solved)) return -1;
  const btScalar time = body.getDeactivationTime();
  Wait& wait = waits_[&body];
  wait.step = step_;
  const btScalar rounding =
      kLastDigits * SIMD_EPSILON * (body.m_bounds[0].absolute() + body.m_bounds[1].absolute()).length();
  wait.displacement = kDisplacement * threshold * size + rounding;
  wait.speed = threshold * unit + rounding / seconds;
  if (wasDisplaced(body, wait)) return -1;
  const btScalar mean = kMeanTime * btSqrt(size / std::max(gravity, kSizesPerSecond * kSizesPerSecond * size));
  const btVector3 velocity = meanVelocity(body);
  wait.velocity += std::min(seconds / mean, btScalar(1)) * (velocity - wait.velocity);
  const bool touched = !solved.elastic || solved.memory->rows.contacts;
  const btScalar unbalanced = kUnbalanced * threshold * gravity * mean + (touched ? rounding / seconds : btScalar(0));
  const bool isBalanced = !((velocity - wait.velocity).length() > unbalanced) || !(gravity > 0);
  const bool isCalm = isBalanced && !(squared > kCalm * kCalm * threshold * threshold);
  return isCalm ? time : std::min(time, std::max(gDeactivationTime - 2 * seconds, btScalar(0)));
}

/// Stores the positions anew if a node has been displaced.
bool Stillness::wasDisplaced(const btSoftBody& body, Wait& wait) {
  const auto count = static_cast<std::size_t>(body.m_nodes.size());
  const bool begins = wait.positions.size() != count;
  bool displaced = begins;
  const btScalar allowed = wait.displacement;
  for (std::size_t n = 0; n < count && !displaced; ++n) {
    displaced = (body.m_nodes[static_cast<int>(n)].m_x - wait.positions[n]).length2() > allowed * allowed;
  }
  if (!displaced) return false;
  wait.positions.resize(count);
  for (std::size_t n = 0; n < count; ++n) wait.positions[n] = body.m_nodes[static_cast<int>(n)].m_x;
  return !begins;
}

/// Each is as long still as the one that has been still for the shortest time. Bullet's islands do not know contacts of
/// soft bodies, nor joints. Multibodies have their own timer.
void Stillness::waitForEachOther(const SolverBodies& bodies, const SolvedSystem& system,
                                 const RigidUnknowns& rigids) const {
  std::vector<btCollisionObject*> members;
  for (const std::size_t b : system.bodies) members.push_back(bodies.bodies()[b].body);
  for (const std::size_t r : system.rigids) {
    if (btRigidBody* rigid = rigids.list()[r].rigid) members.push_back(rigid);
  }
  btScalar shortest = BT_LARGE_FLOAT;
  for (const btCollisionObject* member : members) {
    const bool mayNot = member->getActivationState() == DISABLE_DEACTIVATION;
    shortest = std::min(shortest, mayNot ? btScalar(0) : member->getDeactivationTime());
  }
  for (btCollisionObject* member : members) setTime(*member, std::min(shortest, member->getDeactivationTime()));
}

void Stillness::shift(const btVector3& by) {
  for (auto& [body, wait] : waits_) {
    for (btVector3& position : wait.positions) position += by;
  }
}

/// All of them have waited in the last step.
void Stillness::serialize(WorldStream& stream) {
  stream.byObject(waits_, [&](const btSoftBody&, Wait& wait) {
    stream.each(wait.positions, [&](btVector3& position) { stream(position); });
    stream(wait.velocity, wait.displacement, wait.speed);
    if (stream.restoring()) wait.step = step_;
  });
}

}  // namespace tetskin::bullet_detail
