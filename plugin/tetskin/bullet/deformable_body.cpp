// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/core/tet_geometry.h>

#include <algorithm>

namespace tetskin {
namespace {

/// Largest median of (time step x natural frequency of a node)^2 for a default stiffness. Elastic forces are explicit,
/// and above 4 it is the implicit damping alone that keeps them stable. In free motion it does, at any stiffness; in a
/// hard landing of thin parts it fails between 15 and 30 (measured with cages of 300 to 30,000 tets).
constexpr double kStableFrequency = 8.0;

/// Lamé's parameters of a material: mu, lambda.
std::pair<double, double> lame(double youngsModulus, double poissonRatio) {
  return {youngsModulus / (2.0 * (1.0 + poissonRatio)),
          youngsModulus * poissonRatio / ((1.0 + poissonRatio) * (1.0 - 2.0 * poissonRatio))};
}

/// Median over the nodes of the squared natural frequency for a Young's modulus of 1: stiffness of the node's tets,
/// with its neighbours held, over its mass.
double medianSquaredFrequency(const TetMesh& cage, const SoftBodyOptions& options, double mass) {
  const auto [mu, lambda] = lame(1.0, options.poissonRatio);
  std::vector<double> stiffness(cage.nodeCount(), 0.0);
  for (const Tet& tet : cage.tets) {
    const TetCorners corners = cornersOf(cage, tet);
    const Eigen::Vector4d gradients = BarycentricMap(corners).gradientLengths();
    const double modulus = (lambda + 2.0 * mu) * std::abs(signedVolume(corners));
    for (int k = 0; k < 4; ++k) stiffness[tet[k]] += modulus * gradients[k] * gradients[k];
  }
  const std::vector<double> masses = lumpedMasses(cage, mass);
  for (std::size_t n = 0; n < masses.size(); ++n) stiffness[n] /= masses[n];
  const auto middle = stiffness.begin() + static_cast<std::ptrdiff_t>(stiffness.size() / 2);
  std::nth_element(stiffness.begin(), middle, stiffness.end());
  return *middle;
}

double defaultYoungsModulus(const TetMesh& cage, const SoftBodyOptions& options, double gravity) {
  const double volume = totalVolume(cage);
  const double density = options.density > 0.0 ? options.density : options.mass / volume;
  // Without gravity nothing sags; the earth's serves as a scale.
  constexpr double kEarth = 9.81;
  const double wanted = options.relativeStiffness * density * (gravity > 0.0 ? gravity : kEarth) *
                        boundingBox(cage.nodes).sizes().maxCoeff();
  const double frequency = medianSquaredFrequency(cage, options, density * volume);
  return std::min(wanted, kStableFrequency / (options.timeStep * options.timeStep * frequency));
}

std::unique_ptr<btDeformableLagrangianForce> elasticForce(const SoftBodyOptions& options, double youngsModulus) {
  const auto [shear, first] = lame(youngsModulus, options.poissonRatio);
  const auto mu = static_cast<btScalar>(shear), lambda = static_cast<btScalar>(first);
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
