// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's deformable world adds forces and gravity to the velocities of rigid bodies before it solves, removes gravity
// from the forces, and then solves as the plain world does, whose solver adds the forces again. So forces count twice,
// and contacts, joints and damping see velocities already changed by gravity. Here the solver adds all of them, once.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <vector>

namespace tetskin::bullet_detail {

/// Steps rigid bodies as Bullet's plain world does.
class RigidForces {
 public:
  using Bodies = btAlignedObjectArray<btRigidBody*>;

  /// bodies  those of the world that are not static; must outlive this
  explicit RigidForces(const Bodies& bodies) : bodies_(bodies) {}

  /// At the beginning of a step: stores the velocities.
  void begin();
  /// After Bullet's prediction: restores the velocities, and adds gravity to the forces. Predicted transforms stay.
  void afterPrediction(btScalar seconds);
  /// After Bullet's solve: removes gravity from the forces, which are again the application's.
  void end();

 private:
  struct Before {
    const btRigidBody* body;  ///< may have left the world since
    btVector3 velocity, turning;
    bool hasGravity = false;
  };
  /// The record of a body, by its number in the world; null for one that was not there.
  Before* noted(int number);

  const Bodies& bodies_;
  std::vector<Before> before_;
};

}  // namespace tetskin::bullet_detail
