// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what sleeping bodies lie on and hang on. Bullet wakes them for bodies that move by
// themselves, but neither for what is moved nor for what is gone.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <cstddef>
#include <unordered_map>
#include <vector>

class btOverlappingPairCache;

namespace tetskin {

/// What is beside a body that rests, or holds it: the boxes overlap, and the two may touch.
struct Neighbour {
  const btCollisionObject* object = nullptr;
  bool isHere = true;  ///< in this step
  bool isSoft = false;
  bool isObstacle = false;  ///< static or kinematic
  bool stands = false;      ///< does not move by itself: obstacles, and rigid bodies that sleep
  btTransform transform = btTransform::getIdentity();
  const btCollisionShape* shape = nullptr;
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< the box that the broadphase has of it
};

/// A body that is asleep, or about to be.
struct RestingBody {
  btSoftBody* body = nullptr;
  std::vector<Neighbour> neighbours;
  std::size_t next = 0;    ///< of them: they come in the same order in nearly all steps
  int steps = 0;           ///< for which it has been asleep
  bool isHere = true;      ///< in this step
  bool disturbed = false;  ///< likewise
};

class Sleepers {
 public:
  /// When a step begins, before it is known who is awake: wakes bodies of which a neighbour was moved, got another
  /// shape or size, is gone, or may not be touched any more, and those to which an obstacle has come; keeps awake those
  /// that would fall asleep on what moves. Cost O(bodies), and O(pairs of the broadphase) where one rests.
  void wake(const btAlignedObjectArray<btSoftBody*>& bodies);

 private:
  void listResting(const btAlignedObjectArray<btSoftBody*>& bodies);
  void seePairs(btOverlappingPairCache& pairs);
  RestingBody* find(const btCollisionObject& object) const;

  std::unordered_map<const btCollisionObject*, RestingBody> resting_;
  std::vector<RestingBody*> byIndex_;  ///< in the world's list of objects; null of others
};

}  // namespace tetskin
