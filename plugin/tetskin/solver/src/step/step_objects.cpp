// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/step/step_objects.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Gives access to a protected member of a base class.
struct IslandFinder : btDeformableMultiBodyDynamicsWorld {
  static void find(btDeformableMultiBodyDynamicsWorld& world) {
    (world.*(&IslandFinder::calculateSimulationIslands))();
  }
};

}  // namespace

StepObjects::Noted StepObjects::noted(const btCollisionObject& object) {
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  return {&object, proxy ? proxy->m_uniqueId : 0};
}

std::vector<StepObjects::Noted> StepObjects::objectsOf(const btCollisionWorld& world) {
  const btCollisionObjectArray& all = world.getCollisionObjectArray();
  std::vector<Noted> objects;
  objects.reserve(static_cast<std::size_t>(all.size()));
  for (int k = 0; k < all.size(); ++k) objects.push_back(noted(*all[k]));
  return objects;
}

void StepObjects::note(btDeformableMultiBodyDynamicsWorld* world) {
  world_ = world;
  noted_.clear();
  if (world) noted_ = objectsOf(*world);
}

bool StepObjects::haveChanged() const {
  if (!world_) return false;
  const btCollisionObjectArray& all = world_->getCollisionObjectArray();
  if (static_cast<std::size_t>(all.size()) != noted_.size()) return true;
  for (std::size_t k = 0; k < noted_.size(); ++k) {
    if (noted(*all[static_cast<int>(k)]) != noted_[k]) return true;
  }
  return false;
}

StepObjects::Gone StepObjects::gone() const {
  Gone gone;
  if (!world_) return gone;
  std::vector<Noted> here = objectsOf(*world_);
  std::sort(here.begin(), here.end());
  assert(std::adjacent_find(here.begin(), here.end()) == here.end());  // no object is in the world twice
  for (const Noted& object : noted_) {
    if (!std::binary_search(here.begin(), here.end(), object)) gone.insert(object.first);
  }
  return gone;
}

void findIslands(btDeformableMultiBodyDynamicsWorld& world) {
  IslandFinder::find(world);
}

}  // namespace tetskin::bullet_detail
