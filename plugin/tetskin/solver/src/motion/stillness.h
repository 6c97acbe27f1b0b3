// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: which bodies may fall asleep. Bullet puts a body to sleep that has been slower than a
// speed in world units for two seconds, wherever it is. Here a body sleeps only if it would stay in place anyway: slow
// relative to its size and gravity, near its place at the start of these two seconds, and supported.
#pragma once

#include <tetskin/solver/src/rows/rigid_unknowns.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <unordered_map>
#include <vector>

namespace tetskin::bullet_detail {

class Stillness {
 public:
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
  void forget(const btSoftBody& body) { waits_.erase(&body); }

  /// Writes or reads which bodies wait.
  void serialize(WorldStream& stream);

 private:
  /// A body that waits to fall asleep.
  struct Wait {
    std::vector<btVector3> positions;  ///< of its nodes, when the wait began
    btVector3 velocity{0, 0, 0};       ///< of its centroid, averaged over the last steps
    btScalar displacement = 0;         ///< bound of a node's displacement
    btScalar speed = 0;                ///< bound of a node's speed
    unsigned step = 0;                 ///< the last step in which it waited
  };
  btScalar timeOf(const SolvedBody& solved, btScalar seconds);
  static bool wasDisplaced(const btSoftBody& body, Wait& wait);
  bool isDisturbed(const btSoftBody& body);
  void sleepByIslands(const btCollisionObjectArray& objects, std::vector<btSoftBody*>& asleep);
  void waitForEachOther(const SolverBodies& bodies, const SolvedSystem& system, const RigidUnknowns& rigids) const;

  std::unordered_map<const btSoftBody*, Wait> waits_;
  unsigned step_ = 0;
};

}  // namespace tetskin::bullet_detail
