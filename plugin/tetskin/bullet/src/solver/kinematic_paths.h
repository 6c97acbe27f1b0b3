// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to RigidUnknowns: where kinematic bodies are in each step of a frame. Bullet moves a body that the
// application moves once per frame to its final transform in the frame's first step, and gives it its velocity in all
// of them.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransform.h>

#include <unordered_map>

namespace tetskin {

struct KinematicPath {
  btTransform from = btTransform::getIdentity(),
              to = from;      ///< of the frame; `to` is Bullet's
  int steps = 1;              ///< number of steps in the frame
  int done = 1;               ///< steps of the frame that have begun, including this one
  btTransform before = from;  ///< transform when this step begins
  bool isKnown = false;       ///< a step before has used the body; otherwise `before` equals `to`

  /// The transform at the end of this step.
  btTransform now() const;
  /// Steps, including this one, until the body is where Bullet has it.
  int stepsLeft() const { return steps - done + 1; }
};

class KinematicPaths {
 public:
  /// Call it when a step begins.
  void beginStep();
  /// The path of a kinematic body in this step.
  const KinematicPath& pathOf(const btRigidBody& body, btScalar seconds);

 private:
  std::unordered_map<const btCollisionObject*, KinematicPath> now_, before_;
};

}  // namespace tetskin
