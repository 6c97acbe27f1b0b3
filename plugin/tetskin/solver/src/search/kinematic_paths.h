// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: where kinematic bodies are in each step of a frame. Bullet moves a body that the
// application moves once per frame to its final transform in the frame's first step, and gives it its velocity in all
// of them. Here it moves along a curve whose velocity is continuous.
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
  btTransform from = btTransform::getIdentity(), to = from;  ///< of the frame; `to` is where the application has it
  btTransform before = from;                                 ///< when this step begins
  int steps = 1;                                             ///< number of steps in the frame
  int done = 1;                 ///< steps that have begun since the application has moved it, including this one
  int last = 0;                 ///< steps between the two moves before; 0: not known
  bool isKnown = false;         ///< its transform before this step is known
  bool wasPut = false;          ///< in this step, it was put at another place
  FrameCurve moves, turns;      ///< of the frame: of the origin, and the rotation vector from `from`
  FrameMotion motion, turning;  ///< of the frames so far
  unsigned seen = 0;            ///< number of the last step in which the body was kinematic

  /// The transform at the end of this step.
  btTransform now() const;
  /// Takes the body to another place, on a way that continues its motion.
  /// frame  number of steps; 0: it was put there
  void leadTo(const btTransform& place, int frame, btScalar seconds);
};

class KinematicPaths {
 public:
  /// Call it when a step begins: each kinematic body in the worlds is put where this step takes it, so that what is
  /// moved once per frame is met, in each step, as if it were moved in each step. Cost O(objects).
  void beginStep(const std::vector<btDiscreteDynamicsWorld*>& worlds, btScalar seconds);
  /// Call it when the step ends: puts the bodies back to where the application has them.
  void endStep();

  /// Where an object is when the step begins. Bullet has kinematic ones where it ends already.
  const btTransform& startOf(const btCollisionObject& object) const;
  /// True if the object is kinematic, and its transform when the step begins is known.
  bool knowsStart(const btCollisionObject& object) const;
  /// The path of a kinematic body in this step; null if it has not been seen.
  const KinematicPath* find(const btRigidBody& body) const;
  /// Takes the path of a kinematic body to this step.
  const KinematicPath& advance(const btRigidBody& body, btScalar seconds);

  /// Forgets objects that are gone.
  void forget(const std::unordered_set<const btCollisionObject*>& gone);
  /// Moves the paths, after the bodies have been moved by as much.
  void shift(const btVector3& by);

  /// Writes or reads the paths that bodies are on.
  void visitState(WorldStream& stream);

 private:
  /// A body that is not where the application has it.
  struct Shifted {
    btDiscreteDynamicsWorld* world = nullptr;
    int index = 0;  ///< in the world's list of objects
    btRigidBody* body = nullptr;
    btTransform shown, interpolation;  ///< where it is in this step; its interpolation transform otherwise
  };
  void shift(btDiscreteDynamicsWorld& world, int index, btRigidBody& body, const btTransform& now);

  std::unordered_map<const btRigidBody*, KinematicPath> paths_;
  std::vector<Shifted> shifted_;
  unsigned step_ = 0;
};

}  // namespace tetskin::bullet_detail
