// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/base/contact_filter.h>
#include <tetskin/solver/src/motion/sleepers.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <iterator>

namespace tetskin::bullet_detail {
namespace {

/// Steps until the broadphase knows all neighbours of a body that was added asleep.
constexpr int kStepsToPair = 2;

/// True if the body sleeps, or is about to fall asleep.
bool rests(const btSoftBody& body) {
  return !body.isActive() || body.getActivationState() == WANTS_DEACTIVATION || body.getDeactivationTime() > 0;
}

btBroadphaseInterface* broadphaseOf(const btSoftBody& body) {
  const btSoftBodyWorldInfo* world = const_cast<btSoftBody&>(body).getWorldInfo();
  return world && body.getBroadphaseHandle() ? world->m_broadphase : nullptr;
}

bool mayTouch(const btSoftBody& body, const btCollisionObject& object) {
  const btSoftBody* other = btSoftBody::upcast(&object);
  return other ? collidesWithSoft(body, *other) : collidesWithRigid(body, object);
}

Neighbour neighbourOf(const btCollisionObject& object) {
  Neighbour neighbour;
  neighbour.object = &object;
  neighbour.isSoft = btSoftBody::upcast(&object) != nullptr;
  neighbour.isObstacle = object.isStaticOrKinematicObject();
  neighbour.stands = neighbour.isObstacle || (!object.isActive() && !neighbour.isSoft);
  neighbour.transform = object.getWorldTransform();
  if (neighbour.isObstacle) neighbour.shape = ShapeKey::of(*object.getCollisionShape());
  neighbour.friction = object.getFriction();
  if (const btBroadphaseProxy* proxy = object.getBroadphaseHandle()) {
    neighbour.low = proxy->m_aabbMin;
    neighbour.high = proxy->m_aabbMax;
  }
  return neighbour;
}

bool wasChanged(const Neighbour& before, const Neighbour& now) {
  if (before.isObstacle != now.isObstacle) return true;
  if (!before.stands || !now.stands) return false;
  if (!(before.transform == now.transform) || before.friction != now.friction) return true;
  return now.isObstacle && before.shape != now.shape;
}

/// True if the neighbour has not changed. The box of a body that falls asleep shrinks, and may then no longer overlap
/// it.
bool isStillThere(const btSoftBody& body, const Neighbour& before) {
  assert(broadphaseOf(body));
  struct Finder : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
      if (proxy->m_clientObject == wanted) found = wanted;
      return true;
    }
    const btCollisionObject *wanted = nullptr, *found = nullptr;
  } finder;
  finder.wanted = before.object;
  broadphaseOf(body)->aabbTest(before.low, before.high, finder);
  return finder.found && mayTouch(body, *finder.found) && !wasChanged(before, neighbourOf(*finder.found));
}

Neighbour* findNeighbour(const btCollisionObject& object, RestingBody& sleeper) {
  const std::size_t count = sleeper.neighbours.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = (sleeper.next + k) % count;
    if (sleeper.neighbours[at].object != &object) continue;
    sleeper.next = at + 1;
    return &sleeper.neighbours[at];
  }
  return nullptr;
}

/// Records an object beside the body. A new obstacle has moved there by itself: while the body sleeps, its own box does
/// not change.
void see(const btCollisionObject& object, RestingBody& sleeper) {
  Neighbour* known = findNeighbour(object, sleeper);
  if (known) known->isHere = true;
  if (known && known->isSoft) return;
  const Neighbour now = neighbourOf(object);
  if (!known) {
    sleeper.neighbours.push_back(now);
    sleeper.disturbed |= sleeper.steps > kStepsToPair && now.isObstacle;
    return;
  }
  sleeper.disturbed |= wasChanged(*known, now);
  *known = now;
}

void seeAnchors(RestingBody& sleeper) {
  const auto& anchors = sleeper.body->m_deformableAnchors;
  for (int k = 0; k < anchors.size(); ++k) {
    if (const btCollisionObject* object = anchors[k].m_cti.m_colObj) see(*object, sleeper);
  }
}

void removeStale(RestingBody& sleeper) {
  const bool asleep = !sleeper.body->isActive();
  const auto isGone = [&](const Neighbour& neighbour) {
    if (neighbour.isHere) return false;
    if (asleep && isStillThere(*sleeper.body, neighbour)) return false;
    sleeper.disturbed |= asleep;
    return true;
  };
  sleeper.neighbours.erase(std::remove_if(sleeper.neighbours.begin(), sleeper.neighbours.end(), isGone),
                           sleeper.neighbours.end());
}

/// Compares the body with its stored state. Bullet sets the velocities of a sleeping body to 0 in each step; a body
/// that the application has put to sleep may still have some in the first step, and may have been moved since.
void seeItself(RestingBody& sleeper) {
  btSoftBody& body = *sleeper.body;
  if (body.isActive()) return;
  const SleepingState now(body);
  const bool isNew = !sleeper.before;
  const bool moved = isNew || sleeper.before->nodes != now.nodes;
  const bool changed = !isNew && (moved || sleeper.before->friction != now.friction);
  BodyWithTrees* own = moved ? bodyWithTrees(body) : nullptr;
  if (own) own->countMove();
  sleeper.before = now;
  sleeper.disturbed |= changed || (now.moves && !isNew);
}

/// The shape is the object's, unless the application has replaced it since.
void serialize(WorldStream& stream, Neighbour& neighbour) {
  stream.object(neighbour.object);
  stream(neighbour.isSoft, neighbour.isObstacle, neighbour.stands, neighbour.transform, neighbour.friction,
         neighbour.low, neighbour.high);
  if (!neighbour.isObstacle) return;
  const btCollisionShape* shape = neighbour.object ? neighbour.object->getCollisionShape() : nullptr;
  bool isItsShape = shape && neighbour.shape.shape == shape;
  stream(isItsShape);
  if (stream.restoring()) neighbour.shape.shape = isItsShape ? shape : nullptr;
  stream(neighbour.shape.low, neighbour.shape.high);
}

}  // namespace

/// A pinned node has the inverse mass 0. The products of one node do not depend on those of the one before.
SleepingState::SleepingState(const btSoftBody& body) : friction(body.m_cfg.kDF) {
  constexpr std::uint64_t kOdd[4] = {0x9E3779B97F4A7C15u, 0xC2B2AE3D27D4EB4Fu, 0x165667B19E3779F9u,
                                     0xD6E8FEB86659FD93u};
  const auto bitsOf = [](btScalar value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof value);
    // In a product, the upper bits of a double affect only the upper bits: the signs of two would cancel.
    return bits ^ (bits >> 32);
  };
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    const btVector3& x = node.m_x;
    nodes = 3 * nodes + kOdd[0] * bitsOf(x.x()) + kOdd[1] * bitsOf(x.y()) + kOdd[2] * bitsOf(x.z()) +
            kOdd[3] * bitsOf(node.m_im);
    moves |= !node.m_v.isZero();
  }
}

void Sleepers::store(btSoftBody& body) {
  RestingBody& sleeper = resting_[&body];
  sleeper.body = &body;
  sleeper.before.emplace(body);
}

void Sleepers::wake(const btAlignedObjectArray<btSoftBody*>& bodies) {
  listResting(bodies);
  if (resting_.empty()) return;
  std::vector<btBroadphaseInterface*> worlds;  // one world, unless bodies have been moved to another
  for (const auto& [object, sleeper] : resting_) {
    btBroadphaseInterface* world = broadphaseOf(*sleeper.body);
    if (std::find(worlds.begin(), worlds.end(), world) == worlds.end()) worlds.push_back(world);
  }
  for (btBroadphaseInterface* world : worlds) seePairs(*world->getOverlappingPairCache());
  for (auto& [object, sleeper] : resting_) {
    seeAnchors(sleeper);
    removeStale(sleeper);
    seeItself(sleeper);
    if (sleeper.disturbed) sleeper.body->activate();
  }
}

void Sleepers::listResting(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (auto& [object, sleeper] : resting_) sleeper.isHere = false;
  byIndex_.clear();
  for (int b = 0; b < bodies.size(); ++b) {
    btSoftBody* body = bodies[b];
    const int index = body->getWorldArrayIndex();
    if (!rests(*body) || !broadphaseOf(*body) || index < 0) continue;
    RestingBody& sleeper = resting_[body];
    sleeper.body = body;
    sleeper.isHere = true;
    sleeper.disturbed = false;
    sleeper.next = 0;
    sleeper.steps = body->isActive() ? 0 : sleeper.steps + 1;
    if (body->isActive()) sleeper.before.reset();
    for (Neighbour& neighbour : sleeper.neighbours) neighbour.isHere = false;
    if (byIndex_.size() <= static_cast<std::size_t>(index)) byIndex_.resize(static_cast<std::size_t>(index) + 1);
    byIndex_[static_cast<std::size_t>(index)] = &sleeper;
  }
  for (auto sleeper = resting_.begin(); sleeper != resting_.end();)
    sleeper = sleeper->second.isHere ? std::next(sleeper) : resting_.erase(sleeper);
}

RestingBody* Sleepers::find(const btCollisionObject& object) const {
  const auto index = static_cast<std::size_t>(object.getWorldArrayIndex());
  RestingBody* sleeper = index < byIndex_.size() ? byIndex_[index] : nullptr;
  return sleeper && sleeper->body == &object ? sleeper : nullptr;
}

void Sleepers::seePairs(btOverlappingPairCache& pairs) {
  const int count = pairs.getNumOverlappingPairs();
  const btBroadphasePair* all = count > 0 ? pairs.getOverlappingPairArrayPtr() : nullptr;
  for (int k = 0; k < count; ++k) {
    const auto& first = *static_cast<const btCollisionObject*>(all[k].m_pProxy0->m_clientObject);
    const auto& second = *static_cast<const btCollisionObject*>(all[k].m_pProxy1->m_clientObject);
    RestingBody *ofFirst = find(first), *ofSecond = find(second);
    if (!ofFirst && !ofSecond) continue;
    if (!(ofFirst ? mayTouch(*ofFirst->body, second) : mayTouch(*ofSecond->body, first))) continue;
    if (ofFirst) see(second, *ofFirst);
    if (ofSecond) see(first, *ofSecond);
  }
}

std::vector<const btSoftBody*> Sleepers::changed() const {
  std::vector<const btSoftBody*> bodies;
  for (const auto& [object, sleeper] : resting_) {
    const bool known = sleeper.before && !sleeper.body->isActive();
    if (known && SleepingState(*sleeper.body).nodes != sleeper.before->nodes) bodies.push_back(sleeper.body);
  }
  return bodies;
}

void Sleepers::shift(const btVector3& by, const std::vector<const btSoftBody*>& changed) {
  for (auto& [object, sleeper] : resting_) {
    for (Neighbour& neighbour : sleeper.neighbours) {
      neighbour.transform.getOrigin() += by;
      neighbour.low += by;
      neighbour.high += by;
    }
    const bool same = std::find(changed.begin(), changed.end(), sleeper.body) == changed.end();
    if (sleeper.before && same) sleeper.before->nodes = SleepingState(*sleeper.body).nodes;
  }
}

void Sleepers::forget(const std::unordered_set<const btCollisionObject*>& gone) {
  for (auto sleeper = resting_.begin(); sleeper != resting_.end();) {
    for (Neighbour& neighbour : sleeper->second.neighbours) {
      if (gone.count(neighbour.object) > 0) neighbour.object = nullptr;
    }
    sleeper = gone.count(sleeper->first) > 0 ? resting_.erase(sleeper) : std::next(sleeper);
  }
}

void Sleepers::serialize(WorldStream& stream) {
  stream.byObject(resting_, [&](const btCollisionObject&, RestingBody& sleeper) {
    stream.object(sleeper.body);
    if (!sleeper.body) return stream.fail();
    stream(sleeper.steps);
    stream.each(sleeper.neighbours, [&](Neighbour& neighbour) { bullet_detail::serialize(stream, neighbour); });
    bool isStored = sleeper.before.has_value();
    stream(isStored);
    if (stream.restoring() && isStored) sleeper.before.emplace();
    if (!isStored) return;
    stream(sleeper.before->nodes, sleeper.before->friction);
  });
}

}  // namespace tetskin::bullet_detail
