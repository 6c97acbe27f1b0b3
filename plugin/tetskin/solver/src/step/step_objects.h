// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: which objects Bullet's detection of contacts has seen in a step. Between detection and
// solve, Bullet calls the application (the tick callback that is to come after a step, the solver callback), which may
// remove some of them and add others.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <unordered_set>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

class StepObjects {
 public:
  using Gone = std::unordered_set<const btCollisionObject*>;

  /// Keeps the world's objects. Cost O(objects)
  /// world  null: none
  void note(btDeformableMultiBodyDynamicsWorld* world);
  /// The world of this step, or null.
  btDeformableMultiBodyDynamicsWorld* world() const { return world_; }
  /// True if its objects are not those that were kept. Cost O(objects)
  bool haveChanged() const;
  /// The objects that were kept and are no longer in the world. They may have been deleted, and another object may have
  /// been created at the address of one: it is not one of those that were detected.
  Gone gone() const;

 private:
  /// An object, and the number that the broadphase gives to each object once.
  using Noted = std::pair<const btCollisionObject*, int>;
  static Noted noted(const btCollisionObject& object);
  static std::vector<Noted> objectsOf(const btCollisionWorld& world);

  btDeformableMultiBodyDynamicsWorld* world_ = nullptr;
  std::vector<Noted> noted_;
};

/// Lets Bullet find the islands anew. It keeps their objects by index in the world's list, and would otherwise read,
/// and put to sleep, objects that have been removed from it since.
void findIslands(btDeformableMultiBodyDynamicsWorld& world);

}  // namespace tetskin::bullet_detail
