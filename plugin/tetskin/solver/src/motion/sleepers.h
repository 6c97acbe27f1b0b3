// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: sleeping bodies, and the objects on which they lie or hang. Bullet wakes bodies that
// are touched by objects moving by themselves, but not when the application moves or removes such an object, nor when
// it changes the body itself.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/solver/src/base/shape_key.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

class btOverlappingPairCache;

namespace tetskin::bullet_detail {

class WorldStream;

/// An object beside a resting body, or attached to it: their boxes overlap, and they may collide.
struct Neighbour {
  const btCollisionObject* object = nullptr;
  bool isHere = true;  ///< found in this step
  bool isSoft = false;
  bool isObstacle = false;  ///< static or kinematic
  bool stands = false;      ///< does not move by itself: obstacles and sleeping rigid bodies
  btTransform transform = btTransform::getIdentity();
  ShapeKey shape;
  btScalar friction = 0;
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< its box in the broadphase
};

/// What the application may have changed about a sleeping body.
struct SleepingState {
  std::uint64_t nodes = 0;  ///< a hash of its nodes' positions and masses
  btScalar friction = 0;
  bool moves = false;  ///< any node has a velocity

  SleepingState() = default;
  explicit SleepingState(const btSoftBody& body);
};

/// A body that is asleep, or about to be.
struct RestingBody {
  btSoftBody* body = nullptr;
  std::vector<Neighbour> neighbours;
  std::size_t next = 0;                 ///< next neighbour to compare: in nearly all steps they come in the same order
  int steps = 0;                        ///< number of steps it has slept
  std::optional<SleepingState> before;  ///< as it fell asleep
  bool isHere = true;                   ///< found in this step
  bool disturbed = false;               ///< a neighbour has changed in this step
};

class Sleepers {
 public:
  /// Call it when a step begins, before it is known which bodies are awake. Wakes bodies that were moved, or given a
  /// velocity, other masses or another friction; those with a neighbour that was moved, got another shape or size, was
  /// removed, or may not collide any more; and those that an obstacle has reached. Keeps awake those that would fall
  /// asleep on a moving object. Cost O(bodies), and O(pairs of the broadphase) if one rests.
  void wake(const btAlignedObjectArray<btSoftBody*>& bodies);

  /// Call it when a body falls asleep: stores what the application may change.
  void store(btSoftBody& body);

  /// Moves the stored positions of objects, after the objects have been moved by as much.
  /// changed  the bodies that had been changed in their sleep before
  void shift(const btVector3& by, const std::vector<const btSoftBody*>& changed);
  /// The bodies whose state differs from the one stored when they fell asleep.
  std::vector<const btSoftBody*> changed() const;
  /// Forgets a body that has left the world.
  void forget(const btSoftBody& body) { resting_.erase(&body); }
  /// Forgets objects that are gone: bodies beside one wake, even if a new object has its address and its place.
  void forget(const std::unordered_set<const btCollisionObject*>& gone);

  /// Writes or reads the state of bodies at rest.
  void serialize(WorldStream& stream);

 private:
  void listResting(const btAlignedObjectArray<btSoftBody*>& bodies);
  void seePairs(btOverlappingPairCache& pairs);
  RestingBody* find(const btCollisionObject& object) const;

  std::unordered_map<const btCollisionObject*, RestingBody> resting_;
  std::vector<RestingBody*> byIndex_;  ///< by index in the world's list of objects; null for other objects
};

}  // namespace tetskin::bullet_detail
