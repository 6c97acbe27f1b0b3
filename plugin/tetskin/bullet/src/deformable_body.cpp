// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/src/body_forces.h>
#include <tetskin/core/src/base/lame.h>
#include <tetskin/core/src/base/median.h>
#include <tetskin/core/src/mesh/tet_geometry.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace tetskin {

/// Seconds of damping, and a stiffness.
struct BodyMaterial {
  double youngsModulus = 0.0;
  double poissonRatio = 0.0;
  double damping = 0.0;
};

namespace {

/// Largest median of (time step x natural frequency of a node)^2 for a default stiffness. Elastic forces are explicit,
/// and above 4 it is the implicit damping alone that keeps them stable. In free motion it does, at any stiffness; in a
/// hard landing of thin parts it fails between 15 and 30 (measured with cages of 300 to 30,000 tets).
constexpr double kStableFrequency = 8.0;

/// Median over the nodes of the squared natural frequency for a Young's modulus of 1: stiffness of the node's tets,
/// with its neighbours held, over its mass.
double medianSquaredFrequency(const TetMesh& cage, const SoftBodyOptions& options, double mass) {
  const Lame unit(1.0, options.poissonRatio);
  std::vector<double> stiffness(cage.nodeCount(), 0.0);
  for (const Tet& tet : cage.tets) {
    const TetCorners corners = cornersOf(cage, tet);
    const Eigen::Vector4d gradients = BarycentricMap(corners).gradientLengths();
    const double modulus = (unit.lambda + 2.0 * unit.mu) * std::abs(signedVolume(corners));
    for (int k = 0; k < 4; ++k) stiffness[tet[k]] += modulus * gradients[k] * gradients[k];
  }
  const std::vector<double> masses = lumpedMasses(cage, mass);
  for (std::size_t n = 0; n < masses.size(); ++n) stiffness[n] /= masses[n];
  return median(std::move(stiffness));
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

void setDamping(btDeformableNeoHookeanForce& force, btScalar damping) {
  force.setDamping(damping);
}
/// Damping by mass, the first, would slow even free fall.
void setDamping(btDeformableLinearElasticityForce& force, btScalar damping) {
  force.setDamping(0, damping);
}

template <class Force>
void setMaterial(Force& force, const BodyMaterial& material) {
  const Lame lame(material.youngsModulus, material.poissonRatio);
  force.setLameParameters(static_cast<btScalar>(lame.mu), static_cast<btScalar>(lame.lambda));
  setDamping(force, static_cast<btScalar>(material.damping));
}

Status invalid(const char* message) {
  return {StatusCode::InvalidOption, message};
}

/// Ok if Bullet's scalars can hold it.
Status checkRange(const BodyMaterial& material) {
  const Lame lame(material.youngsModulus, material.poissonRatio);
  const auto held = [](double value) { return std::isfinite(static_cast<btScalar>(value)); };
  if (held(lame.mu) && held(lame.lambda) && held(material.damping) && held(lame.lambda * material.damping)) return {};
  return invalid("a material so stiff, or so strongly damped, is beyond the range of Bullet's numbers");
}

}  // namespace

/// The members of a DeformableBody, in an order in which forces go before the body that they are for.
struct DeformableBody::Parts {
  Parts(btDeformableMultiBodyDynamicsWorld& ofWorld, ForceList& ofForces, std::unique_ptr<btSoftBody> made)
      : world(ofWorld), list(ofForces), body(std::move(made)), gravity(ofWorld, ofForces) {}

  btDeformableMultiBodyDynamicsWorld& world;
  ForceList& list;
  std::unique_ptr<btSoftBody> body;
  std::vector<btScalar> masses;  ///< by node: what it has when it is not pinned
  BodyMaterial material;
  BodyGravity gravity;
  std::unique_ptr<btDeformableLagrangianForce> elasticity;
  std::function<void(const BodyMaterial&)> applyMaterial;  ///< to `elasticity`, which is one of several types

  template <class Force>
  void makeElasticity() {
    auto force = std::make_unique<OwnForce<Force>>(list);
    applyMaterial = [to = force.get()](const BodyMaterial& now) { setMaterial(*to, now); };
    elasticity = std::move(force);
  }
  void apply(const BodyMaterial& now) {
    material = now;
    applyMaterial(now);
    body->activate();
  }
  Status set(const BodyMaterial& now) {
    Status status = checkRange(now);
    if (status.ok()) apply(now);
    return status;
  }
  Status checkNode(int node) const {
    if (node >= 0 && node < static_cast<int>(masses.size())) return {};
    return {StatusCode::IndexOutOfRange,
            "there is no node " + std::to_string(node) + " in a cage of " + std::to_string(masses.size()) + " nodes"};
  }
};

DeformableBody::DeformableBody(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<DeformableBody>> DeformableBody::add(btDeformableMultiBodyDynamicsWorld& world,
                                                            const TetMesh& cage, const SoftBodyOptions& options) {
  if (options.forceModel == ForceModel::MassSpring) {
    return invalid(
        "mass-spring bodies are not stable in the deformable world; choose neo-Hookean or linear elasticity, or add "
        "the body to a btSoftRigidDynamicsWorld");
  }
  Result<std::unique_ptr<btSoftBody>> made = makeSoftBody(cage, world.getWorldInfo(), options);
  if (!made.ok()) return made.status();
  std::unique_ptr<btSoftBody> body = std::move(made).value();
  const double gravity = static_cast<double>(world.getGravity().length());
  const double stiffness =
      options.youngsModulus > 0.0 ? options.youngsModulus : defaultYoungsModulus(cage, options, gravity);
  const BodyMaterial material{stiffness, options.poissonRatio, options.damping};
  if (Status status = checkRange(material); !status.ok()) return status;
  if (options.configureWorld) {
    world.setUseProjection(true);
    if (options.implicit) world.setLineSearch(false);
    if (options.implicit) world.setImplicit(*options.implicit);
  }
  world.addSoftBody(body.get());
  auto* solver = static_cast<btDeformableBodySolver*>(body->getSoftBodySolver());

  auto parts = std::make_unique<Parts>(world, *solver->getLagrangianForceArray(), std::move(body));
  const double mass = options.density > 0.0 ? options.density * totalVolume(cage) : options.mass;
  for (const double m : lumpedMasses(cage, mass)) parts->masses.push_back(static_cast<btScalar>(m));
  if (options.forceModel == ForceModel::LinearElasticity) {
    parts->makeElasticity<btDeformableLinearElasticityForce>();
  } else {
    parts->makeElasticity<btDeformableNeoHookeanForce>();
  }
  parts->apply(material);
  for (btDeformableLagrangianForce* force :
       {static_cast<btDeformableLagrangianForce*>(&parts->gravity), parts->elasticity.get()}) {
    force->setIndices(solver->getIndices());
  }
  addToList(parts->list, parts->gravity, *parts->elasticity, *parts->body);
  return std::unique_ptr<DeformableBody>(new DeformableBody(std::move(parts)));
}

DeformableBody::~DeformableBody() {
  // Taken out of the world, by the application or by the world's own end: nothing there is left to be told, and nothing
  // may be there to tell.
  if (!parts_->body->getBroadphaseHandle()) return;
  removeFromList(parts_->list, &parts_->gravity);
  removeFromList(parts_->list, parts_->elasticity.get());
  parts_->world.removeSoftBody(parts_->body.get());
}

btSoftBody& DeformableBody::body() {
  return *parts_->body;
}
const btSoftBody& DeformableBody::body() const {
  return *parts_->body;
}
double DeformableBody::youngsModulus() const {
  return parts_->material.youngsModulus;
}
double DeformableBody::poissonRatio() const {
  return parts_->material.poissonRatio;
}
double DeformableBody::damping() const {
  return parts_->material.damping;
}

Status DeformableBody::setYoungsModulus(double pressure) {
  if (!(pressure > 0.0 && std::isfinite(pressure))) return invalid("a Young's modulus must be above 0, and finite");
  return parts_->set({pressure, poissonRatio(), damping()});
}

Status DeformableBody::setPoissonRatio(double ratio) {
  if (!(ratio >= 0.0 && ratio < 0.5)) return invalid("a Poisson's ratio must be at least 0 and below 0.5");
  return parts_->set({youngsModulus(), ratio, damping()});
}

Status DeformableBody::setDamping(double seconds) {
  if (!(seconds >= 0.0 && std::isfinite(seconds))) return invalid("damping must not be negative, and must be finite");
  return parts_->set({youngsModulus(), poissonRatio(), seconds});
}

void DeformableBody::setGravity(const btVector3& gravity) {
  parts_->gravity.set(gravity);
  body().activate();
}

void DeformableBody::followWorldGravity() {
  parts_->gravity.set({});
  body().activate();
}

bool DeformableBody::isPinned(int node) const {
  assert(parts_->checkNode(node).ok());
  return body().m_nodes[node].m_im == 0;
}

Status DeformableBody::pin(int node) {
  if (Status status = parts_->checkNode(node); !status.ok()) return status;
  btSoftBody::Node& pinned = body().m_nodes[node];
  if (pinned.m_im > 0) parts_->masses[static_cast<std::size_t>(node)] = 1 / pinned.m_im;
  for (btVector3* rate : {&pinned.m_v, &pinned.m_vn, &pinned.m_splitv}) rate->setZero();
  body().setMass(node, 0);
  body().activate();
  return {};
}

Status DeformableBody::unpin(int node) {
  if (Status status = parts_->checkNode(node); !status.ok()) return status;
  if (isPinned(node)) body().setMass(node, parts_->masses[static_cast<std::size_t>(node)]);
  body().activate();
  return {};
}

}  // namespace tetskin
