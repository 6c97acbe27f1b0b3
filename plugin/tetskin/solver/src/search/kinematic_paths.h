// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: where kinematic bodies are in each step of a frame. When the application moves a body
// once per frame, Bullet puts it at its final transform in the frame's first step, but gives it its velocity in all of
// them. Here it moves along a curve with a continuous velocity.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransform.h>
#include <tetskin/solver/src/base/frame_curve.h>

#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace tetskin::bullet_detail {

class WorldStream;

struct KinematicPath {
  btTransform from = btTransform::getIdentity(), to = from;  ///< of the frame; `to` is the application's
  btTransform before = from;                                 ///< at the beginning of this step
  int steps = 1;                                             ///< number of steps in the frame
  int done = 1;                 ///< steps begun since the application moved it, including this one
  int last = 0;                 ///< steps between the two moves before; 0: unknown
  bool isKnown = false;         ///< its transform before this step is known
  bool wasPut = false;          ///< it was put at another place in this step
  FrameCurve moves, turns;      ///< of the frame: of the origin, and of the rotation vector from `from`
  FrameMotion motion, turning;  ///< of the frames so far
  unsigned seen = 0;            ///< number of the last step in which the body was kinematic

  /// The transform at the end of this step.
  btTransform now() const;
  /// Moves the body to another place, on a path that continues its motion.
  /// frame  number of steps; 0: it is put there at once
  void leadTo(const btTransform& place, int frame, btScalar seconds);
};

class KinematicPaths {
 public:
  /// Call it when a step begins. Puts each kinematic body in the worlds where this step takes it, so that contacts see
  /// a body that is moved once per frame as if it were moved in each step. Cost O(objects).
  void beginStep(const std::vector<btDiscreteDynamicsWorld*>& worlds, btScalar seconds);
  /// Call it when the step ends: puts the bodies back where the application has them.
  void endStep();

  /// Where an object is at the beginning of the step. Bullet already has kinematic ones at its end.
  const btTransform& startOf(const btCollisionObject& object) const;
  /// True if the object is kinematic, and its transform at the beginning of the step is known.
  bool knowsStart(const btCollisionObject& object) const;
  /// The path of a kinematic body in this step; null if it has not been seen.
  const KinematicPath* find(const btRigidBody& body) const;
  /// Advances the path of a kinematic body to this step.
  const KinematicPath& advance(const btRigidBody& body, btScalar seconds);

  /// Forgets objects that are gone.
  void forget(const std::unordered_set<const btCollisionObject*>& gone);
  /// Moves the paths, after the bodies have been moved by as much.
  void shift(const btVector3& by);

  /// Writes or reads the paths of bodies.
  void serialize(WorldStream& stream);

 private:
  /// A body that is not where the application has put it.
  struct Shifted {
    btDiscreteDynamicsWorld* world = nullptr;
    int index = 0;  ///< in the world's list of objects
    btRigidBody* body = nullptr;
    btTransform shown, interpolation;  ///< its transform in this step; its interpolation transform otherwise
  };
  void shift(btDiscreteDynamicsWorld& world, int index, btRigidBody& body, const btTransform& now);

  std::unordered_map<const btRigidBody*, KinematicPath> paths_;
  std::vector<Shifted> shifted_;
  unsigned step_ = 0;
};

}  // namespace tetskin::bullet_detail
