// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/bullet/soft_body_adapter.h>

#include <memory>
#include <vector>

namespace tetskin::scenes {

/// Bullet's deformable world with everything it takes to make one, and static obstacles, all owned here. Soft bodies
/// must leave it before it goes.
class DeformableWorld {
 public:
  explicit DeformableWorld(const btVector3& gravity = btVector3(0, btScalar(-9.81), 0));
  ~DeformableWorld();
  DeformableWorld(const DeformableWorld&) = delete;
  DeformableWorld& operator=(const DeformableWorld&) = delete;

  btDeformableMultiBodyDynamicsWorld& world() { return world_; }

  void addStaticBox(const btVector3& halfExtents, const btTransform& where);
  void addStaticSphere(btScalar radius, const btVector3& centre);

 private:
  void addStatic(std::unique_ptr<btCollisionShape> shape, const btTransform& where);

  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver bodySolver_;
  btDeformableMultiBodyConstraintSolver constraintSolver_;
  btDeformableMultiBodyDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> obstacles_;
};

/// Sends a node without inverse mass to where it shall be at the end of a substep. Bullet moves it by its velocity, and
/// changes that by no force: so it arrives, and its neighbours feel it move.
void moveHeldNode(btSoftBody::Node& node, const Eigen::Vector3d& target, double seconds);

}  // namespace tetskin::scenes
