// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the objects on which sleeping bodies lie or hang. Bullet wakes bodies when objects that
// move by themselves touch them, but not when such an object is moved by the application or removed.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <cstddef>
#include <unordered_map>
#include <vector>

class btOverlappingPairCache;

namespace tetskin {

/// An object beside a resting body, or attached to it: the boxes overlap, and the two may collide.
struct Neighbour {
  const btCollisionObject* object = nullptr;
  bool isHere = true;  ///< found in this step
  bool isSoft = false;
  bool isObstacle = false;  ///< static or kinematic
  bool stands = false;      ///< does not move by itself: obstacles, and sleeping rigid bodies
  btTransform transform = btTransform::getIdentity();
  const btCollisionShape* shape = nullptr;
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< its box in the broadphase
};

/// A body that is asleep, or about to be.
struct RestingBody {
  btSoftBody* body = nullptr;
  std::vector<Neighbour> neighbours;
  std::size_t next = 0;    ///< next neighbour to compare: they come in the same order in nearly all steps
  int steps = 0;           ///< steps for which it has slept
  bool isHere = true;      ///< found in this step
  bool disturbed = false;  ///< true if a neighbour has changed in this step
};

class Sleepers {
 public:
  /// Call it when a step begins, before it is known which bodies are awake. It wakes bodies of which a neighbour was
  /// moved, got another shape or size, was removed, or may not collide any more, and those that an obstacle has
  /// reached; it keeps awake those that would fall asleep on a moving object. Cost O(bodies), and O(pairs of the
  /// broadphase) if one rests.
  void wake(const btAlignedObjectArray<btSoftBody*>& bodies);

 private:
  void listResting(const btAlignedObjectArray<btSoftBody*>& bodies);
  void seePairs(btOverlappingPairCache& pairs);
  RestingBody* find(const btCollisionObject& object) const;

  std::unordered_map<const btCollisionObject*, RestingBody> resting_;
  std::vector<RestingBody*> byIndex_;  ///< by index in the world's list of objects; null for other objects
};

}  // namespace tetskin
