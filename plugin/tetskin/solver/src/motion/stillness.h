// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: which bodies may fall asleep. Bullet puts a body to sleep that has been slower than a
// speed in world units for two seconds, wherever it is. Here a body sleeps only if it would stay in place anyway: slow
// relative to its size and gravity, supported, not drifting, and held by forces that balance. It may sway a little.
#pragma once

#include <tetskin/solver/src/rows/rigid_unknowns.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <unordered_map>
#include <vector>

namespace tetskin::bullet_detail {

class Stillness {
 public:
  /// Seconds for which bodies must be seen at rest.
  btScalar sleepAfter = btScalar(0.5);

  /// Call it when a step begins, before it is known which bodies are awake. Puts the bodies that have waited long
  /// enough to sleep, with all others of their islands in the worlds, as Bullet does. But Bullet does so in the middle
  /// of a step, and then solves only a part of it; the forces on the bodies should be those of a whole step.
  /// Returns  the soft bodies among them
  std::vector<btSoftBody*> fallAsleep(const std::vector<btDiscreteDynamicsWorld*>& worlds);
  /// Call it in each step when velocities and contacts are known, before Bullet judges by `m_maxSpeedSquared`: a body
  /// that does not stay starts to wait anew, and bodies that are solved for together wait for each other.
  void judge(SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds);

  void shift(const btVector3& by);
  /// Forgets a body that has left the world.
  void forget(const btCollisionObject& body) { waits_.erase(&body); }

  /// Writes or reads which bodies wait, and for how long they must.
  void serialize(WorldStream& stream);

 private:
  /// A body as it is judged: its nodes, or points of a rigid one.
  struct Motion {
    std::vector<btVector3> points;
    btVector3 velocity{0, 0, 0}, gravity{0, 0, 0};
    btScalar size = 0, squaredSpeed = 0;  ///< of the fastest point
    btScalar far = 0;                     ///< distance from the origin, which bounds the rounding of positions
    btScalar threshold = 0;               ///< Bullet's, of soft bodies
    bool touched = false;                 ///< positions are rounded in contact
    bool sticks = false;                  ///< friction or a joint holds it
  };
  /// Where the points of a body were some time ago.
  struct Past {
    std::vector<btVector3> points;
    btScalar seconds = 0;   ///< since then
    btScalar farthest = 0;  ///< the longest way of a point from there since then
    btScalar returned = 0;  ///< the longest from which it has come back
  };
  /// A body that waits to fall asleep.
  struct Wait {
    Past still;                   ///< since it has been still
    Past older, newer;            ///< the older one is at least as old as the body must wait
    btVector3 velocity{0, 0, 0};  ///< of its centroid, averaged over the last steps
    btScalar balanced = 0;        ///< seconds for which the forces along gravity have balanced
    btScalar clock = 0;           ///< Bullet's count when the step had been judged: falls if something wakes the body
    btScalar displacement = 0;    ///< bound of a point's way from `newer` until the next step begins
    btScalar speed = 0;           ///< bound of a point's speed
    bool rests = false;           ///< has been seen at rest for long enough
    unsigned step = 0;            ///< the last step in which it waited
  };
  bool waits(const btCollisionObject& object, const Motion& motion, btScalar seconds);
  void judge(SolvedBody& solved, bool sticks, btScalar seconds);
  void judge(btRigidBody& rigid, bool sticks, btScalar seconds);
  bool isDisturbed(const btSoftBody& body) const;
  void sleepByIslands(const btCollisionObjectArray& objects, std::vector<btSoftBody*>& asleep);
  bool rests(const btCollisionObject& object) const;
  static btScalar wayFrom(Past& past, const std::vector<btVector3>& points);
  bool isBalanced(const Motion& motion, btScalar rounding, btScalar seconds, Wait& wait) const;
  void waitForEachOther(const std::vector<btCollisionObject*>& members, btScalar seconds);

  std::unordered_map<const btCollisionObject*, Wait> waits_;
  Motion motion_;  ///< scratch
  unsigned step_ = 0;
};

}  // namespace tetskin::bullet_detail
