// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <tetskin/bullet/src/shared/bodies/contact_filter.h>
#include <tetskin/bullet/src/solver/sleepers.h>

#include <algorithm>
#include <iterator>

namespace tetskin {
namespace {

/// Steps until the broadphase knows all that is beside a body that was put to sleep as it was added.
constexpr int kStepsToPair = 2;

/// Asleep, or about to be.
bool rests(const btSoftBody& body) {
  return !body.isActive() || body.getActivationState() == WANTS_DEACTIVATION || body.getDeactivationTime() > 0;
}

btBroadphaseInterface* broadphaseOf(const btSoftBody& body) {
  const btSoftBodyWorldInfo* world = const_cast<btSoftBody&>(body).getWorldInfo();
  return world && body.getBroadphaseHandle() ? world->m_broadphase : nullptr;
}

bool mayTouch(const btSoftBody& body, const btCollisionObject& object) {
  const btSoftBody* other = btSoftBody::upcast(&object);
  return other ? meetsSoft(body, *other) : meetsRigid(body, object);
}

Neighbour neighbourOf(const btCollisionObject& object) {
  Neighbour neighbour;
  neighbour.object = &object;
  neighbour.isSoft = btSoftBody::upcast(&object) != nullptr;
  neighbour.isObstacle = object.isStaticOrKinematicObject();
  neighbour.stands = neighbour.isObstacle || (!object.isActive() && !neighbour.isSoft);
  neighbour.transform = object.getWorldTransform();
  neighbour.shape = object.getCollisionShape();
  if (const btBroadphaseProxy* proxy = object.getBroadphaseHandle()) {
    neighbour.low = proxy->m_aabbMin;
    neighbour.high = proxy->m_aabbMax;
  }
  return neighbour;
}

/// Boxes of what may move also hold where it goes.
bool wasChanged(const Neighbour& before, const Neighbour& now) {
  if (before.isObstacle != now.isObstacle) return true;
  if (!before.stands || !now.stands) return false;
  if (!(before.transform == now.transform)) return true;
  const bool sameBox = before.low == now.low && before.high == now.high;
  return now.isObstacle && !(before.shape == now.shape && sameBox);
}

/// A box of the body that shrinks as it falls asleep may part from what has not changed.
bool isStillThere(const btSoftBody& body, const Neighbour& before) {
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

Neighbour* findNeighbour(const btCollisionObject& object, RestingBody& of) {
  const std::size_t count = of.neighbours.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = (of.next + k) % count;
    if (of.neighbours[at].object != &object) continue;
    of.next = at + 1;
    return &of.neighbours[at];
  }
  return nullptr;
}

/// An obstacle that is new has come: as long as the body is asleep, its own box stays.
void see(const btCollisionObject& object, RestingBody& of) {
  Neighbour* known = findNeighbour(object, of);
  if (known) known->isHere = true;
  if (known && known->isSoft) return;
  const Neighbour now = neighbourOf(object);
  if (!known) {
    of.neighbours.push_back(now);
    of.disturbed |= of.steps > kStepsToPair && now.isObstacle;
    return;
  }
  of.disturbed |= wasChanged(*known, now);
  *known = now;
}

void seeAnchors(RestingBody& of) {
  const auto& anchors = of.body->m_deformableAnchors;
  for (int k = 0; k < anchors.size(); ++k) {
    if (const btCollisionObject* object = anchors[k].m_cti.m_colObj) see(*object, of);
  }
}

void forgetWhatIsGone(RestingBody& of) {
  const bool asleep = !of.body->isActive();
  const auto isGone = [&](const Neighbour& neighbour) {
    if (neighbour.isHere) return false;
    if (asleep && isStillThere(*of.body, neighbour)) return false;
    of.disturbed |= asleep;
    return true;
  };
  of.neighbours.erase(std::remove_if(of.neighbours.begin(), of.neighbours.end(), isGone), of.neighbours.end());
}

}  // namespace

void Sleepers::wake(const btAlignedObjectArray<btSoftBody*>& bodies) {
  listResting(bodies);
  if (resting_.empty()) return;
  std::vector<btBroadphaseInterface*> worlds;  // one, but for bodies that have been moved to another
  for (const auto& [object, of] : resting_) {
    btBroadphaseInterface* world = broadphaseOf(*of.body);
    if (std::find(worlds.begin(), worlds.end(), world) == worlds.end()) worlds.push_back(world);
  }
  for (btBroadphaseInterface* world : worlds) seePairs(*world->getOverlappingPairCache());
  for (auto& [object, of] : resting_) {
    seeAnchors(of);
    forgetWhatIsGone(of);
    if (of.disturbed) of.body->activate();
  }
}

void Sleepers::listResting(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (auto& [object, of] : resting_) of.isHere = false;
  byIndex_.clear();
  for (int b = 0; b < bodies.size(); ++b) {
    btSoftBody* body = bodies[b];
    const int index = body->getWorldArrayIndex();
    if (!rests(*body) || !broadphaseOf(*body) || index < 0) continue;
    RestingBody& of = resting_[body];
    of.body = body;
    of.isHere = true;
    of.disturbed = false;
    of.next = 0;
    of.steps = body->isActive() ? 0 : of.steps + 1;
    for (Neighbour& neighbour : of.neighbours) neighbour.isHere = false;
    if (byIndex_.size() <= static_cast<std::size_t>(index)) byIndex_.resize(static_cast<std::size_t>(index) + 1);
    byIndex_[static_cast<std::size_t>(index)] = &of;
  }
  for (auto of = resting_.begin(); of != resting_.end();) of = of->second.isHere ? std::next(of) : resting_.erase(of);
}

RestingBody* Sleepers::find(const btCollisionObject& object) const {
  const auto index = static_cast<std::size_t>(object.getWorldArrayIndex());
  RestingBody* of = index < byIndex_.size() ? byIndex_[index] : nullptr;
  return of && of->body == &object ? of : nullptr;
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

}  // namespace tetskin
