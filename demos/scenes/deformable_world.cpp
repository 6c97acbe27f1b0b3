// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/deformable_world.h"

namespace tetskin::scenes {

DeformableWorld::DeformableWorld(const btVector3& gravity)
    : world_(&dispatcher_, &broadphase_, &constraintSolver_, &configuration_, &bodySolver_) {
  constraintSolver_.setDeformableSolver(&bodySolver_);
  world_.setGravity(gravity);
  world_.getWorldInfo().m_gravity = gravity;
  world_.getWorldInfo().m_sparsesdf.Initialize();
}

DeformableWorld::~DeformableWorld() {
  for (const auto& obstacle : obstacles_) world_.removeRigidBody(obstacle.get());
}

void DeformableWorld::addStaticBox(const btVector3& halfExtents, const btTransform& where) {
  addStatic(std::make_unique<btBoxShape>(halfExtents), where);
}

void DeformableWorld::addStaticSphere(btScalar radius, const btVector3& centre) {
  addStatic(std::make_unique<btSphereShape>(radius), btTransform(btQuaternion::getIdentity(), centre));
}

void DeformableWorld::addStatic(std::unique_ptr<btCollisionShape> shape, const btTransform& where) {
  auto body = std::make_unique<btRigidBody>(btScalar(0), nullptr, shape.get());
  body->setWorldTransform(where);
  body->setFriction(1);
  world_.addRigidBody(body.get());
  shapes_.push_back(std::move(shape));
  obstacles_.push_back(std::move(body));
}

void moveHeldNode(btSoftBody::Node& node, const Eigen::Vector3d& target, double seconds) {
  node.m_v = (toBullet(target) - node.m_x) / static_cast<btScalar>(seconds);
}

}  // namespace tetskin::scenes
