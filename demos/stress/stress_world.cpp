// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/stress_world.h"

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btDeformableCorotatedForce.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <tetskin/bullet/deformable_body.h>

#include "scenes/deformable_world.h"
#include "scenes/input_error.h"
#include "stress/events.h"

namespace tetskin::stress {
namespace {

constexpr double kEarth = 9.81;

SoftBodyOptions bodyOptions(const StressCase& stressCase, const StressModel& model) {
  SoftBodyOptions options;
  options.youngsModulus = stressCase.stiffness;
  options.poissonRatio = stressCase.poisson;
  options.damping = stressCase.damping;
  options.timeStep = stressCase.substep();
  options.implicit = stressCase.implicit;
  options.pinned = heldNodes(stressCase.event, model.cage);
  if (stressCase.force == Force::LinearElasticity) options.forceModel = ForceModel::LinearElasticity;
  if (stressCase.force == Force::MassSpring) {
    options.forceModel = ForceModel::MassSpring;
    if (stressCase.stiffness > 0.0) options.linkStiffness = stressCase.stiffness;
  }
  return options;
}

btVector3 gravityOf(const StressCase& stressCase, const StressModel& model) {
  // In proportion to the size, so that bodies of all sizes fall alike.
  return {0, static_cast<btScalar>(hasFloor(stressCase.event) ? -kEarth * model.size / kSize : 0.0), 0};
}

class DeformableStressWorld : public StressWorld {
 public:
  DeformableStressWorld(const StressCase& stressCase, const StressModel& model) : scene_(gravityOf(stressCase, model)) {
    auto made = DeformableBody::add(scene_.world(), model.bodyCage, bodyOptions(stressCase, model));
    scenes::require(made.status());
    body_ = std::move(made).value();
  }
  ~DeformableStressWorld() override { removeBoxes(); }
  btSoftBody& body() override { return body_->body(); }
  btDiscreteDynamicsWorld& world() override { return scene_.world(); }

 private:
  scenes::DeformableWorld scene_;
  std::unique_ptr<DeformableBody> body_;
};

/// Bullet's corotated force, which the library does not offer: it has no damping, and no implicit form.
class CorotatedStressWorld : public StressWorld {
 public:
  CorotatedStressWorld(const StressCase& stressCase, const StressModel& model)
      : scene_(gravityOf(stressCase, model)), gravity_(gravityOf(stressCase, model)) {
    const double shear = stressCase.stiffness / (2.0 * (1.0 + stressCase.poisson));
    elasticity_.m_mu = static_cast<btScalar>(shear);
    elasticity_.m_lambda = static_cast<btScalar>(2.0 * shear * stressCase.poisson / (1.0 - 2.0 * stressCase.poisson));
    Result<btSoftBody*> made =
        makeSoftBody(model.bodyCage, scene_.world().getWorldInfo(), bodyOptions(stressCase, model));
    scenes::require(made.status());
    body_.reset(made.value());
    scene_.world().setImplicit(stressCase.implicit);
    scene_.world().setLineSearch(false);
    scene_.world().setUseProjection(true);
    scene_.world().addSoftBody(body_.get());
    scene_.world().addForce(body_.get(), &gravity_);
    scene_.world().addForce(body_.get(), &elasticity_);
  }
  ~CorotatedStressWorld() override {
    removeBoxes();
    scene_.world().removeSoftBody(body_.get());
  }
  btSoftBody& body() override { return *body_; }
  btDiscreteDynamicsWorld& world() override { return scene_.world(); }

 private:
  scenes::DeformableWorld scene_;
  btDeformableGravityForce gravity_;
  btDeformableCorotatedForce elasticity_;
  std::unique_ptr<btSoftBody> body_;
};

class ClassicStressWorld : public StressWorld {
 public:
  ClassicStressWorld(const StressCase& stressCase, const StressModel& model) {
    const btVector3 gravity = gravityOf(stressCase, model);
    world_.setGravity(gravity);
    world_.getWorldInfo().m_gravity = gravity;
    world_.getWorldInfo().m_sparsesdf.Initialize();
    Result<btSoftBody*> made = makeSoftBody(model.bodyCage, world_.getWorldInfo(), bodyOptions(stressCase, model));
    scenes::require(made.status());
    body_.reset(made.value());
    world_.addSoftBody(body_.get());
  }
  ~ClassicStressWorld() override {
    removeBoxes();
    world_.removeSoftBody(body_.get());
  }
  btSoftBody& body() override { return *body_; }
  btDiscreteDynamicsWorld& world() override { return world_; }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver constraintSolver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &constraintSolver_, &configuration_};
  std::unique_ptr<btSoftBody> body_;
};

std::unique_ptr<StressWorld> makeWorld(const StressCase& stressCase, const StressModel& model) {
  if (stressCase.force == Force::MassSpring) return std::make_unique<ClassicStressWorld>(stressCase, model);
  if (stressCase.force == Force::Corotated) return std::make_unique<CorotatedStressWorld>(stressCase, model);
  return std::make_unique<DeformableStressWorld>(stressCase, model);
}

}  // namespace

std::unique_ptr<StressWorld> StressWorld::make(const StressCase& stressCase, const StressModel& model) {
  std::unique_ptr<StressWorld> made = makeWorld(stressCase, model);
  made->body().setActivationState(DISABLE_DEACTIVATION);  // every step is to be followed
  if (model.offset != Eigen::Vector3d::Zero()) made->body().translate(toBullet(model.offset));
  return made;
}

void StressWorld::addBox(const btVector3& halfExtents, const btVector3& centre, btScalar mass) {
  auto shape = std::make_unique<btBoxShape>(halfExtents);
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  auto box = std::make_unique<btRigidBody>(mass, nullptr, shape.get(), inertia);
  box->setWorldTransform(btTransform(btQuaternion::getIdentity(), centre));
  box->setFriction(1);
  world().addRigidBody(box.get());
  shapes_.push_back(std::move(shape));
  boxes_.push_back(std::move(box));
}

void StressWorld::removeBoxes() {
  for (const auto& box : boxes_) world().removeRigidBody(box.get());
  boxes_.clear();
}

void StressWorld::step(const StressCase& stressCase) {
  // One substep at a time: Bullet's own division of a frame may leave one out by rounding.
  for (int k = 0; k < stressCase.substeps; ++k) {
    world().stepSimulation(static_cast<btScalar>(stressCase.substep()), 0);
  }
}

double documentedStableStiffness(const TetMesh& cage, double substep) {
  scenes::DeformableWorld scene;
  SoftBodyOptions options;
  options.relativeStiffness = 1e30;
  options.timeStep = substep;
  auto made = DeformableBody::add(scene.world(), cage, options);
  scenes::require(made.status());
  return made.value()->youngsModulus();
}

}  // namespace tetskin::stress
