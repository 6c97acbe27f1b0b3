// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Each of Bullet's worlds with a soft body in it, ready to step.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body.h>

#include <memory>

#include "support/one_kilogram.h"

namespace tetskin::test {

/// A world with a floor at y = 0. Derived classes create the world and remove their body before the world is destroyed.
class TestWorld {
 public:
  virtual ~TestWorld() { world->removeRigidBody(floor.get()); }
  TestWorld(const TestWorld&) = delete;
  TestWorld& operator=(const TestWorld&) = delete;

  btSoftBody& body() const { return *body_; }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  std::unique_ptr<btConstraintSolver> solver;
  std::unique_ptr<btSoftBodySolver> softSolver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;

 protected:
  TestWorld() = default;
  void addFloor() {
    const btVector3 gravity(0, -10, 0);
    world->setGravity(gravity);
    floor = std::make_unique<btRigidBody>(0, nullptr, &floorShape);
    btTransform below;
    below.setIdentity();
    below.setOrigin(btVector3(0, -1, 0));
    floor->setWorldTransform(below);
    world->addRigidBody(floor.get());
  }

  btBoxShape floorShape{btVector3(20, 1, 20)};
  std::unique_ptr<btRigidBody> floor;
  std::unique_ptr<btSoftBody> body_;
};

/// The classic worlds differ only in type.
template <class World, class Solver>
class ClassicWorld : public TestWorld {
 public:
  explicit ClassicWorld(const TetMesh& cage, SoftBodyOptions options = {}) {
    auto constraintSolver = std::make_unique<Solver>();
    auto concrete = std::make_unique<World>(&dispatcher, &broadphase, constraintSolver.get(), &configuration);
    soft = concrete.get();
    solver = std::move(constraintSolver);
    world = std::move(concrete);
    addFloor();
    soft->getWorldInfo().m_gravity.setValue(0, -10, 0);
    soft->getWorldInfo().m_sparsesdf.Initialize();
    options = oneKilogram(options);
    options.forceModel = ForceModel::MassSpring;
    body_ = createSoftBody(cage, soft->getWorldInfo(), options).value();
    soft->addSoftBody(body_.get());
  }
  ~ClassicWorld() override { soft->removeSoftBody(body_.get()); }

 private:
  World* soft;
};

using RigidWorld = ClassicWorld<btSoftRigidDynamicsWorld, btSequentialImpulseConstraintSolver>;
using MultiBodyWorld = ClassicWorld<btSoftMultiBodyDynamicsWorld, btMultiBodyConstraintSolver>;

/// Deformable worlds share everything except the body and its solver.
class DeformableWorldBase : public TestWorld {
 public:
  ~DeformableWorldBase() override {
    if (body_) soft->removeSoftBody(body_.get());
  }

 protected:
  explicit DeformableWorldBase(std::unique_ptr<btDeformableBodySolver> bodySolver) {
    auto constraintSolver = std::make_unique<btDeformableMultiBodyConstraintSolver>();
    constraintSolver->setDeformableSolver(bodySolver.get());
    auto concrete = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
        &dispatcher, &broadphase, constraintSolver.get(), &configuration, bodySolver.get());
    soft = concrete.get();
    softSolver = std::move(bodySolver);
    solver = std::move(constraintSolver);
    world = std::move(concrete);
    addFloor();
    soft->getWorldInfo().m_gravity.setValue(0, -10, 0);
    soft->getWorldInfo().m_sparsesdf.Initialize();
    soft->setImplicit(false);
    soft->setLineSearch(false);
    soft->setUseProjection(true);
  }

  btDeformableMultiBodyDynamicsWorld* soft;
  btDeformableGravityForce gravity{btVector3(0, -10, 0)};
  // The force is here, not in the class that adds it: the body leaves the world, with its forces, in this class's
  // destructor.
  btDeformableNeoHookeanForce elasticity{400, 600, btScalar(0.05)};
};

class DeformableWorld : public DeformableWorldBase {
 public:
  explicit DeformableWorld(const TetMesh& cage) : DeformableWorldBase(std::make_unique<btDeformableBodySolver>()) {
    body_ = createSoftBody(cage, soft->getWorldInfo(), oneKilogram()).value();
    soft->addSoftBody(body_.get());
    soft->addForce(body_.get(), &gravity);
    soft->addForce(body_.get(), &elasticity);
  }
};

/// A reduced body with two modes that are polynomials of the rest position: it needs no files.
class ReducedWorld : public DeformableWorldBase {
 public:
  explicit ReducedWorld(const TetMesh& cage);
};

}  // namespace tetskin::test
