// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what sleeping bodies lie on and hang on. Bullet wakes them for bodies that move by
// themselves, but neither for what is moved nor for what is gone.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <unordered_map>
#include <vector>

namespace tetskin {

/// What is beside a body that rests, or holds it: the boxes overlap, and the two may touch.
struct Neighbour {
  const btCollisionObject* object = nullptr;
  bool isObstacle = false;  ///< static or kinematic
  bool stands = false;      ///< does not move by itself: obstacles, and rigid bodies that sleep
  btTransform transform;
  const btCollisionShape* shape = nullptr;
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< the box that the broadphase has of it
};

class Sleepers {
 public:
  /// When a step begins, before it is known who is awake: wakes bodies of which a neighbour was moved, got another
  /// shape or size, is gone, or may not be touched any more, and those to which an obstacle has come; keeps awake those
  /// that would fall asleep on what moves. Cost O(bodies), and O(pairs of the broadphase) where one rests.
  void wake(const btAlignedObjectArray<btSoftBody*>& bodies);

 private:
  struct Rest {
    std::vector<Neighbour> before, now;  ///< sorted by object
    int steps = 0;                       ///< for which it has been asleep
    bool isHere = false;                 ///< in this step
  };
  using Bodies = std::unordered_map<const btCollisionObject*, Rest>;

  void listResting(const btAlignedObjectArray<btSoftBody*>& bodies);
  void listPairs(btOverlappingPairCache& pairs);
  static void wakeIfDisturbed(btSoftBody& body, Rest& rest);

  Bodies resting_;
};

}  // namespace tetskin
