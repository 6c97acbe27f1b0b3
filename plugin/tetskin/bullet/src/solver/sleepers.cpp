// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <tetskin/bullet/src/shared/bodies/contact_filter.h>
#include <tetskin/bullet/src/solver/sleepers.h>

#include <algorithm>
#include <functional>

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
  neighbour.isObstacle = object.isStaticOrKinematicObject();
  neighbour.stands = neighbour.isObstacle || (!object.isActive() && !btSoftBody::upcast(&object));
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

bool comesBefore(const Neighbour& a, const Neighbour& b) {
  return std::less<>()(a.object, b.object);
}

void sortOnce(std::vector<Neighbour>& neighbours) {
  const auto same = [](const Neighbour& a, const Neighbour& b) { return a.object == b.object; };
  std::sort(neighbours.begin(), neighbours.end(), comesBefore);
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end(), same), neighbours.end());
}

const Neighbour* find(const std::vector<Neighbour>& sorted, const Neighbour& wanted) {
  const auto found = std::lower_bound(sorted.begin(), sorted.end(), wanted, comesBefore);
  return found != sorted.end() && found->object == wanted.object ? &*found : nullptr;
}

/// As long as it is asleep, its own box stays.
bool hasCome(const std::vector<Neighbour>& before, const std::vector<Neighbour>& now) {
  return std::any_of(now.begin(), now.end(), [&](const Neighbour& of) { return of.isObstacle && !find(before, of); });
}

}  // namespace

void Sleepers::wake(const btAlignedObjectArray<btSoftBody*>& bodies) {
  listResting(bodies);
  if (resting_.empty()) return;
  std::vector<btBroadphaseInterface*> worlds;  // one, but for bodies that have been moved to another
  for (int b = 0; b < bodies.size(); ++b) {
    btBroadphaseInterface* world = broadphaseOf(*bodies[b]);
    if (world && std::find(worlds.begin(), worlds.end(), world) == worlds.end()) worlds.push_back(world);
  }
  for (btBroadphaseInterface* world : worlds) listPairs(*world->getOverlappingPairCache());
  for (int b = 0; b < bodies.size(); ++b) {
    const auto found = resting_.find(bodies[b]);
    if (found != resting_.end()) wakeIfDisturbed(*bodies[b], found->second);
  }
}

void Sleepers::listResting(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (auto& [body, rest] : resting_) rest.isHere = false;
  for (int b = 0; b < bodies.size(); ++b) {
    if (!rests(*bodies[b]) || !broadphaseOf(*bodies[b])) continue;
    Rest& rest = resting_[bodies[b]];
    rest.isHere = true;
    rest.now.clear();
    const auto& anchors = bodies[b]->m_deformableAnchors;
    for (int k = 0; k < anchors.size(); ++k) {
      if (const btCollisionObject* object = anchors[k].m_cti.m_colObj) rest.now.push_back(neighbourOf(*object));
    }
  }
  for (auto of = resting_.begin(); of != resting_.end();) of = of->second.isHere ? std::next(of) : resting_.erase(of);
}

void Sleepers::listPairs(btOverlappingPairCache& pairs) {
  const int count = pairs.getNumOverlappingPairs();
  const btBroadphasePair* all = count > 0 ? pairs.getOverlappingPairArrayPtr() : nullptr;
  const auto add = [&](const btBroadphaseProxy& own, const btBroadphaseProxy& other) {
    const auto found = resting_.find(static_cast<const btCollisionObject*>(own.m_clientObject));
    if (found == resting_.end()) return;
    const auto& object = *static_cast<const btCollisionObject*>(other.m_clientObject);
    if (mayTouch(*btSoftBody::upcast(found->first), object)) found->second.now.push_back(neighbourOf(object));
  };
  for (int k = 0; k < count; ++k) {
    add(*all[k].m_pProxy0, *all[k].m_pProxy1);
    add(*all[k].m_pProxy1, *all[k].m_pProxy0);
  }
}

void Sleepers::wakeIfDisturbed(btSoftBody& body, Rest& rest) {
  sortOnce(rest.now);
  rest.steps = body.isActive() ? 0 : rest.steps + 1;
  bool disturbed = rest.steps > kStepsToPair && hasCome(rest.before, rest.now);
  for (const Neighbour& before : rest.before) {
    const Neighbour* now = find(rest.now, before);
    disturbed |= now && wasChanged(before, *now);
    if (now || body.isActive()) continue;
    isStillThere(body, before) ? rest.now.push_back(before) : (void)(disturbed = true);
  }
  rest.before.swap(rest.now);
  sortOnce(rest.before);
  if (disturbed) body.activate();
}

}  // namespace tetskin
