// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's deformable world adds forces and gravity to the velocities of rigid bodies before it solves, takes gravity
// out of the forces, and solves as the plain world does, whose solver adds the forces: they count twice, and contacts,
// joints, and damping see velocities that gravity has changed already. Here its solver adds all of them, once.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <vector>

namespace tetskin::bullet_detail {

/// Steps rigid bodies as Bullet's plain world does.
class RigidForces {
 public:
  using Bodies = btAlignedObjectArray<btRigidBody*>;

  /// bodies  those of the world that are not static; they must live as long as this
  explicit RigidForces(const Bodies& bodies) : bodies_(bodies) {}

  /// When a step begins: notes the velocities.
  void begin();
  /// After Bullet's prediction: gives the velocities back, and gravity to the forces. Predicted transforms stay.
  void afterPrediction(btScalar seconds);
  /// After Bullet's solve: takes gravity from the forces, which are the application's again.
  void end();

 private:
  struct Before {
    const btRigidBody* body;  ///< may have left the world since
    btVector3 velocity, turning;
    bool hasGravity = false;
  };
  /// What was noted of a body of the world, by its number there; null for one that was not there.
  Before* noted(int number);

  const Bodies& bodies_;
  std::vector<Before> before_;
};

}  // namespace tetskin::bullet_detail
