// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rigid bodies for the tests of the solver, and the momentum of rigid and soft bodies.
#pragma once

#include "deformable_test.h"

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <utility>

namespace tetskin::test {

/// A box or a ball, which is in a world as long as this object lives.
struct Rigid {
  Rigid(TetskinWorld& in, std::unique_ptr<btCollisionShape> ofShape, btScalar mass, const btVector3& at)
      : world(in), shape(std::move(ofShape)) {
    btVector3 inertia;
    shape->calculateLocalInertia(mass, inertia);
    body = std::make_unique<btRigidBody>(mass, nullptr, shape.get(), inertia);
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    body->setInterpolationWorldTransform(body->getWorldTransform());
    body->setFriction(btScalar(0.5));
    world.deformable().addRigidBody(body.get());
  }
  ~Rigid() { world.deformable().removeRigidBody(body.get()); }
  Rigid(const Rigid&) = delete;
  Rigid& operator=(const Rigid&) = delete;

  btVector3 momentum() const { return body->getLinearVelocity() / body->getInvMass(); }
  /// Angular momentum about the origin.
  btVector3 spin() const {
    const btMatrix3x3& frame = body->getWorldTransform().getBasis();
    const btVector3 own = frame * (body->getLocalInertia() * (frame.transpose() * body->getAngularVelocity()));
    return own + body->getWorldTransform().getOrigin().cross(momentum());
  }
  double kineticEnergy() const {
    const btVector3 turn = body->getWorldTransform().getBasis().transpose() * body->getAngularVelocity();
    const btVector3 inertia = body->getLocalInertia();
    return 0.5 * static_cast<double>(momentum().dot(body->getLinearVelocity()) + turn.dot(inertia * turn));
  }
  double height() const { return static_cast<double>(body->getWorldTransform().getOrigin().y()); }

  TetskinWorld& world;
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> body;
};

inline std::unique_ptr<btCollisionShape> ball() {
  return std::make_unique<btSphereShape>(btScalar(0.25));
}

inline btVector3 momentumOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) sum += body.m_nodes[n].m_v / body.m_nodes[n].m_im;
  return sum;
}

/// Angular momentum about the origin.
inline btVector3 spinOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    sum += body.m_nodes[n].m_x.cross(body.m_nodes[n].m_v / body.m_nodes[n].m_im);
  }
  return sum;
}

inline void forEachSubstep(TetskinWorld& world, int steps, const std::function<void()>& then) {
  for (int k = 0; k < steps; ++k) {
    world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    then();
  }
}

/// A block that flies at whatever is above the origin, in a world without gravity.
struct FlyingBlock {
  explicit FlyingBlock(double height = 5.0) {
    world.deformable().setGravity(btVector3(0, 0, 0));
    TetMesh cage = latticeCage(3, 3, 3, 0.3);
    for (Eigen::Vector3d& p : cage.nodes) p += Eigen::Vector3d(-0.45, height, -0.45);
    block = added(world, cage);
    block->body().m_cfg.kDF = btScalar(0.5);
  }
  btSoftBody& body() { return block->body(); }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> block;
};

}  // namespace tetskin::test
