// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rotations of rigid bodies as Bullet computes them, but with our own sine: that of the C library, which Bullet uses,
// has other last bits on other platforms.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <vector>

namespace tetskin::bullet_detail {

/// Rotation after a time, as `btTransformUtil::integrateTransform` computes it.
/// velocity  radians per second, world space
btMatrix3x3 turned(const btTransform& from, const btVector3& velocity, btScalar seconds);

/// Repeats, for a world, the rotations that Bullet has computed.
class RigidTurns {
 public:
  using Bodies = btAlignedObjectArray<btRigidBody*>;

  /// Turns the predicted transforms (`getInterpolationWorldTransform`), after Bullet's prediction.
  static void predict(const Bodies& bodies, btScalar seconds);
  /// Stores the rotations from which Bullet is about to integrate.
  void begin(const Bodies& bodies);
  /// Call it after that: turns the bodies, except those that Bullet's continuous detection has stopped on their way.
  void end(const Bodies& bodies, btScalar seconds) const;

 private:
  struct Before {
    btTransform transform;
    btVector3 velocity;
  };
  std::vector<Before> before_;  ///< by number of the body
};

}  // namespace tetskin::bullet_detail
