// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Turns of rigid bodies as Bullet makes them, but by our own sine: that of the C library, which Bullet takes, has other
// last bits elsewhere.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <vector>

namespace tetskin::bullet_detail {

/// Rotation after a time, as of `btTransformUtil::integrateTransform`.
/// velocity  radians per second, world space
btMatrix3x3 turned(const btTransform& from, const btVector3& velocity, btScalar seconds);

/// Does for a world what Bullet does, once more.
class RigidTurns {
 public:
  using Bodies = btAlignedObjectArray<btRigidBody*>;

  /// Turns the predicted transforms (`getInterpolationWorldTransform`), after Bullet's prediction.
  static void predict(const Bodies& bodies, btScalar seconds);
  /// Notes the rotations from which Bullet is about to integrate.
  void begin(const Bodies& bodies);
  /// After that: turns the bodies. Those that Bullet's continuous detection has stopped on their way stay as they are.
  void end(const Bodies& bodies, btScalar seconds) const;

 private:
  struct Before {
    btTransform transform;
    btVector3 velocity;
  };
  std::vector<Before> before_;  ///< by number of the body
};

}  // namespace tetskin::bullet_detail
