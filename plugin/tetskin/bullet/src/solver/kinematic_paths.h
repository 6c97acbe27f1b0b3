// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to RigidUnknowns: where kinematic bodies are in each step of a frame. Bullet puts one that is moved once a
// frame where it goes in the frame's first step, and gives it its velocity in all of them.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransform.h>

#include <unordered_map>

namespace tetskin {

struct KinematicPath {
  btTransform from = btTransform::getIdentity(), to = from;  ///< of the frame; `to` is what Bullet has
  int steps = 1;                                             ///< of the frame
  int done = 1;                                              ///< of them, with this one
  btTransform before = from;                                 ///< where it is when this step begins
  bool isKnown = false;                                      ///< was met in the step before: else `before` is `to`

  /// Where it is at the end of this step.
  btTransform now() const;
  /// Steps, with this one, until it is where Bullet has it.
  int stepsLeft() const { return steps - done + 1; }
};

class KinematicPaths {
 public:
  /// When a step begins.
  void beginStep();
  /// Of a kinematic body, in this step.
  const KinematicPath& of(const btRigidBody& body, btScalar seconds);

 private:
  std::unordered_map<const btCollisionObject*, KinematicPath> now_, before_;
};

}  // namespace tetskin
