// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <tetskin/bullet/deformable_body.h>

namespace tetskin {
namespace {

double defaultYoungsModulus(const TetMesh& cage, const SoftBodyOptions& options, double gravity) {
  const double density = options.density > 0.0 ? options.density : options.mass / totalVolume(cage);
  // Without gravity nothing sags; the earth's serves as a scale.
  constexpr double kEarth = 9.81;
  return options.relativeStiffness * density * (gravity > 0.0 ? gravity : kEarth) *
         boundingBox(cage.nodes).sizes().maxCoeff();
}

std::unique_ptr<btDeformableLagrangianForce> elasticForce(const SoftBodyOptions& options, double youngsModulus) {
  // Lamé's parameters from Young's modulus and Poisson's ratio.
  const double nu = options.poissonRatio;
  const auto mu = static_cast<btScalar>(youngsModulus / (2.0 * (1.0 + nu)));
  const auto lambda = static_cast<btScalar>(youngsModulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)));
  const auto damping = static_cast<btScalar>(options.damping);
  if (options.forceModel == ForceModel::LinearElasticity) {
    // Third and fourth: damping by mass, which would slow even free fall, and by stiffness.
    return std::make_unique<btDeformableLinearElasticityForce>(mu, lambda, btScalar(0), damping);
  }
  return std::make_unique<btDeformableNeoHookeanForce>(mu, lambda, damping);
}

}  // namespace

DeformableBody::DeformableBody(btDeformableMultiBodyDynamicsWorld& world, std::unique_ptr<btSoftBody> body)
    : world_(world), body_(std::move(body)) {}

Result<std::unique_ptr<DeformableBody>> DeformableBody::add(btDeformableMultiBodyDynamicsWorld& world,
                                                            const TetMesh& cage, const SoftBodyOptions& options) {
  if (options.forceModel == ForceModel::MassSpring) {
    return Status{StatusCode::InvalidOption,
                  "mass-spring bodies are not stable in the deformable world; choose neo-Hookean or linear elasticity, "
                  "or add the body to a btSoftRigidDynamicsWorld"};
  }
  Result<btSoftBody*> made = makeSoftBody(cage, world.getWorldInfo(), options);
  if (!made.ok()) return made.status();
  std::unique_ptr<DeformableBody> result(new DeformableBody(world, std::unique_ptr<btSoftBody>(made.value())));
  world.getWorldInfo().m_gravity = world.getGravity();
  world.setImplicit(options.implicit);
  world.setLineSearch(false);
  world.setUseProjection(true);
  world.addSoftBody(&result->body());
  result->addForces(cage, options);
  return result;
}

void DeformableBody::addForces(const TetMesh& cage, const SoftBodyOptions& options) {
  const btVector3 gravity = world_.getGravity();
  youngsModulus_ = options.youngsModulus > 0.0
                       ? options.youngsModulus
                       : defaultYoungsModulus(cage, options, static_cast<double>(gravity.length()));
  forces_.push_back(std::make_unique<btDeformableGravityForce>(gravity));
  forces_.push_back(elasticForce(options, youngsModulus_));
  // Past btDeformableMultiBodyDynamicsWorld::addForce, which would merge them with other bodies' by type alone.
  auto* solver = static_cast<btDeformableBodySolver*>(body_->getSoftBodySolver());
  for (const auto& force : forces_) {
    force->addSoftBody(body_.get());
    force->setIndices(solver->getIndices());
    solver->getLagrangianForceArray()->push_back(force.get());
  }
}

DeformableBody::~DeformableBody() {
  auto* solver = static_cast<btDeformableBodySolver*>(body_->getSoftBodySolver());
  if (!solver) return;
  for (const auto& force : forces_) solver->getLagrangianForceArray()->remove(force.get());
  world_.removeSoftBody(body_.get());
}

}  // namespace tetskin
