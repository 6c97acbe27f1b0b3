// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBodySolver.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <tetskin/reduced/src/bodies/modal_body.h>

#include <cassert>
#include <cmath>

namespace tetskin::reduced_detail {
namespace {

/// Mass of a pinned body's frame while Bullet computes the effect of an impulse on the modes: the frame takes none of
/// it.
constexpr btScalar kHeldMass = btScalar(1e30);

/// Gives access to the length of the current substep, which Bullet does not publish.
struct Step : btReducedDeformableBodySolver {
  static btScalar seconds(const btReducedDeformableBodySolver& solver) { return solver.*(&Step::m_dt); }
  static const btVector3& gravity(const btReducedDeformableBodySolver& solver) { return solver.*(&Step::m_gravity); }
};

btMatrix3x3 toBulletMatrix(const Eigen::Matrix3d& m) {
  const auto at = [&](int i, int j) { return static_cast<btScalar>(m(i, j)); };
  return {at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1), at(1, 2), at(2, 0), at(2, 1), at(2, 2)};
}

btVector3 toBulletVector(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

}  // namespace

class ModalBody::Shape : public btSoftBodyCollisionShape {
 public:
  explicit Shape(ModalBody& body) : btSoftBodyCollisionShape(&body), body_(body) {}
  void getAabb(const btTransform& transform, btVector3& low, btVector3& high) const override {
    body_.correctPrediction();
    btSoftBodyCollisionShape::getAabb(transform, low, high);
  }

 private:
  ModalBody& body_;
};

ModalBody::ModalBody(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes, bool pinned)
    : btReducedDeformableBody(&worldInfo, static_cast<int>(nodes.size()), nodes.data(), nullptr),
      pinned_(pinned),
      sleepSpeed_(m_sleepingThreshold),
      threshold_(m_sleepingThreshold) {
  m_sst.sdt = 0;            // Bullet does not initialise it
  delete m_collisionShape;  // as btSoftBody's destructor does
  m_collisionShape = new Shape(*this);
}

void ModalBody::begin(const CageModes& modes, const std::vector<double>& eigenvalues, const ModalMaterial& material) {
  assert(eigenvalues.size() == modes.shapes.size() && modes.masses.size() == static_cast<std::size_t>(m_nodes.size()));
  const double root = std::sqrt(material.density);
  damping_ = static_cast<btScalar>(material.damping);
  setReducedModes(static_cast<int>(eigenvalues.size()), m_nodes.size());
  m_modes.resize(m_nReduced);
  m_eigenvalues.resize(m_nReduced);
  m_Kr.resize(m_nReduced);
  for (int r = 0; r < m_nReduced; ++r) {
    const std::vector<double>& shape = modes.shapes[static_cast<std::size_t>(r)];
    m_eigenvalues[r] =
        static_cast<btScalar>(eigenvalues[static_cast<std::size_t>(r)] * material.youngsModulus / material.density);
    m_Kr[r] = m_eigenvalues[r];
    m_modes[r].resize(3 * m_nFull);
    for (int k = 0; k < 3 * m_nFull; ++k)
      m_modes[r][k] = static_cast<btScalar>(shape[static_cast<std::size_t>(k)] / root);
    momenta_.push_back(toBulletVector(root * modes.momenta[static_cast<std::size_t>(r)]));
  }
  setMasses(modes, material.density);
  const btScalar mass = m_mass;
  if (pinned_) m_mass = kHeldMass;
  internalInitialization();
  m_mass = mass;
  // Bullet skips contacts of nodes without inverse mass: pushing a node that does not move would push all modes, by as
  // much as it takes to move the node.
  for (int n = 0; n < m_nFull; ++n) {
    if (pinned_ && modes.pinned[static_cast<std::size_t>(n)]) m_nodes[n].m_im = 0;
  }
}

/// The mass, centre and inertia of the fine body, instead of those of the cage's nodes, which are farther out.
void ModalBody::setMasses(const CageModes& modes, double density) {
  assert(density > 0.0 && modes.mass > 0.0);
  tDenseArray masses;
  masses.resize(m_nFull);
  for (int n = 0; n < m_nFull; ++n) {
    masses[n] = static_cast<btScalar>(density * modes.masses[static_cast<std::size_t>(n)]);
  }
  setMassProps(masses);
  m_mass = static_cast<btScalar>(density * modes.mass);
  m_inverseMass = 1 / m_mass;
  m_initialCoM = toBulletVector(modes.centre);
  setInertiaProps();
  m_invInertiaLocal = toBulletMatrix((density * modes.inertia).inverse());
  if (pinned_) m_invInertiaLocal = toBulletMatrix(Eigen::Matrix3d::Zero());
  if (pinned_) m_linearFactor.setZero();
  m_invInertiaTensorWorldInitial = m_invInertiaLocal;
  setFrame(m_rigidTransformWorld);
}

void ModalBody::setFrame(const btTransform& frame) {
  frame_ = m_rigidTransformWorld = m_interpolationWorldTransform = frame;
  m_invInertiaTensorWorld = frame.getBasis() * m_invInertiaTensorWorldInitial * frame.getBasis().transpose();
  m_interpolateInvInertiaTensorWorld = m_invInertiaTensorWorld;
}

void ModalBody::placeAt(const btTransform& placement) {
  assert(m_nReduced > 0);
  setFrame(btTransform(placement.getBasis(), placement * m_initialCoM));
  rest();
  mapToFullPosition(m_rigidTransformWorld);
  mapToFullVelocity(m_rigidTransformWorld);
  updateExternalForceProjectMatrix(true);
  updateNormals();
  updateBounds();
  updateNodeTree(false, false);
  if (!m_fdbvt.empty()) updateFaceTree(false, false);
  activate();
}

btMatrix3x3 ModalBody::getImpulseFactor(int node) {
  assert(node >= 0 && node < m_nFull);
  // Without the mass of the frame, because the frame of a pinned body does not move.
  const btScalar mass = m_mass;
  if (pinned_) m_mass = kHeldMass;
  const btMatrix3x3 factor = btReducedDeformableBody::getImpulseFactor(node);
  m_mass = mass;
  return factor;
}

void ModalBody::rest() {
  m_linearVelocity.setZero();
  m_angularVelocity.setZero();
  for (int r = 0; r < m_nReduced; ++r) m_reducedVelocity[r] = m_reducedVelocityBuffer[r] = 0;
  m_interpolationWorldTransform = m_rigidTransformWorld;
}

/// Bullet also integrates sleeping bodies, which rounds their frame anew each time. Restoring the same frame keeps the
/// same bits.
void ModalBody::stay() {
  if (!slept_ && !pinned_) frame_ = m_rigidTransformWorld;
  slept_ = true;
  m_rigidTransformWorld = frame_;
  rest();
}

/// May be called any number of times in a substep before contacts are solved: its result depends only on the state
/// before the substep. Between steps, it only sets velocities of nodes, which the next step overwrites.
void ModalBody::correctPrediction() {
  // While the body is being added to the world, its solver may not know the length of a step yet.
  if (!m_softBodySolver || !getBroadphaseHandle()) return;
  if (m_softBodySolver->getSolverType() != btSoftBodySolver::REDUCED_DEFORMABLE_SOLVER) return;
  const auto* solver = static_cast<const btReducedDeformableBodySolver*>(m_softBodySolver);
  for (int n = 0; n < m_nodes.size(); ++n) m_nodes[n].index = n;
  if (!isActive()) return stay();
  slept_ = false;
  const btScalar seconds = Step::seconds(*solver);
  const btVector3& gravity = Step::gravity(*solver);
  if (m_sleepingThreshold != threshold_) sleepSpeed_ = m_sleepingThreshold;
  m_sleepingThreshold = threshold_ = pinned_ ? sleepSpeed_ : sleepSpeed_ + gravity.length() * seconds;
  if (pinned_) {
    m_linearVelocity.setZero();
    m_angularVelocity.setZero();
    m_rigidTransformWorld = m_interpolationWorldTransform = frame_;
    mapToFullPosition(frame_);
  }
  if (!isReducedModesOFF()) vibrate(seconds, gravity);
  mapToFullVelocity(m_interpolationWorldTransform);
}

/// Symplectic Euler, with the damping of backward Euler: v' = v + dt (f - damping K v').
void ModalBody::vibrate(btScalar seconds, const btVector3& gravity) {
  assert(momenta_.size() == static_cast<std::size_t>(m_nReduced));
  const btVector3 pull = pinned_ ? gravity * frame_.getBasis() : btVector3(0, 0, 0);  // in the body's frame
  for (int r = 0; r < m_nReduced; ++r) {
    const btScalar force = m_reducedForceElastic[r] + momenta_[static_cast<std::size_t>(r)].dot(pull);
    m_reducedVelocity[r] = (m_reducedVelocityBuffer[r] + seconds * force) / (1 + seconds * damping_ * m_eigenvalues[r]);
  }
}

}  // namespace tetskin::reduced_detail
