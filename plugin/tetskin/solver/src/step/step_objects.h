// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: which objects Bullet's contact detection has seen in a step. Between detection and
// solve, Bullet calls the application (the post-tick callback and the solver callback), which may remove some of them
// and add others.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <unordered_set>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

class StepObjects {
 public:
  using Gone = std::unordered_set<const btCollisionObject*>;

  /// Stores the world's objects. Cost O(objects)
  /// world  null: none
  void note(btDeformableMultiBodyDynamicsWorld* world);
  /// The world of this step, or null.
  btDeformableMultiBodyDynamicsWorld* world() const { return world_; }
  /// True if the world's objects differ from the stored ones. Cost O(objects)
  bool haveChanged() const;
  /// The stored objects that are no longer in the world. They may have been deleted; an object created since at the
  /// same address is not one of those that were detected.
  Gone gone() const;

 private:
  /// An object, and the unique number that the broadphase gives it.
  using Noted = std::pair<const btCollisionObject*, int>;
  static Noted noted(const btCollisionObject& object);
  static std::vector<Noted> objectsOf(const btCollisionWorld& world);

  btDeformableMultiBodyDynamicsWorld* world_ = nullptr;
  std::vector<Noted> noted_;
};

/// Makes Bullet find the islands anew. It keeps their objects by index in the world's list, and would otherwise read,
/// and put to sleep, objects that have since been removed.
void findIslands(btDeformableMultiBodyDynamicsWorld& world);

}  // namespace tetskin::bullet_detail
