// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <tetskin/bullet/src/base/body_elements.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/core/src/base/median.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/forces/elastic_force.h>
#include <tetskin/solver/src/search/contact_algorithm.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <string>

namespace tetskin {

using namespace bullet_detail;

namespace {

/// Largest median of (time step x natural frequency of a node)^2 for a default stiffness. Elastic forces are explicit;
/// above 4 only the implicit damping keeps them stable. In free motion it does so at any stiffness; in a hard landing
/// of thin parts it fails between 15 and 30 (measured with cages of 300 to 30,000 tets).
constexpr double kStableFrequency = 8.0;

/// Median over the nodes of the squared natural frequency for a Young's modulus of 1: the stiffness of the node's tets
/// with its neighbours pinned, divided by its mass.
double medianSquaredFrequency(const TetMesh& cage, const SoftBodyOptions& options, const std::vector<double>& masses) {
  assert(masses.size() == cage.nodeCount());
  const elastic_detail::Lame unit = elastic_detail::lameOf(1.0, options.poissonRatio);
  std::vector<double> stiffness(cage.nodeCount(), 0.0);
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const Tet& tet = cage.tets[t];
    const TetCorners corners = cornersOf(cage, tet);
    const Eigen::Vector4d gradients = BarycentricMap(corners).gradientLengths();
    const double scale = options.stiffnessScale.empty() ? 1.0 : options.stiffnessScale[t];
    const double modulus = scale * (unit.lambda + 2.0 * unit.mu) * std::abs(signedVolume(corners));
    for (int k = 0; k < 4; ++k) stiffness[tet[k]] += modulus * gradients[k] * gradients[k];
  }
  for (std::size_t n = 0; n < masses.size(); ++n) stiffness[n] /= masses[n];
  return median(std::move(stiffness));
}

/// Volume of the material. A cage's masses are those of a density of 1, unless a density is painted.
double materialVolume(const Cage& cage) {
  if (cage.paintedDensity.empty() && !cage.masses.empty())
    return std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
  double filled = 0.0;
  for (std::size_t t = 0; t < cage.volumeFraction.size(); ++t)
    filled += cage.volumeFraction[t] * std::abs(signedVolume(cornersOf(cage.mesh, cage.mesh.tets[t])));
  return !cage.masses.empty() && filled > 0.0 ? filled : totalVolume(cage.mesh);
}

/// Density times gravity times size: the unit of relative stiffness.
double weightPressure(const Cage& cage, const std::vector<double>& masses, double gravity) {
  assert(masses.size() == cage.mesh.nodeCount());
  const double density = std::accumulate(masses.begin(), masses.end(), 0.0) / materialVolume(cage);
  // Without gravity nothing sags; the earth's gravity then sets the scale.
  constexpr double kEarth = 9.81;
  return density * (gravity > 0.0 ? gravity : kEarth) * boundingBox(cage.mesh.nodes).sizes().maxCoeff();
}

/// pressure  see `weightPressure`
/// bounded   limit it to what explicit elastic forces can simulate stably
double defaultYoungsModulus(const TetMesh& cage, const SoftBodyOptions& options, const std::vector<double>& masses,
                            double pressure, bool bounded) {
  const double wanted = options.relativeStiffness * pressure;
  if (!bounded) return wanted;
  const double frequency = medianSquaredFrequency(cage, options, masses);
  return std::min(wanted, kStableFrequency / (options.timeStep * options.timeStep * frequency));
}

void setDamping(btDeformableNeoHookeanForce& force, btScalar damping) {
  force.setDamping(damping);
}
/// The first argument, mass-proportional damping, would slow even free fall.
void setDamping(btDeformableLinearElasticityForce& force, btScalar damping) {
  force.setDamping(0, damping);
}

void setWorld(ElasticForce& force, btDeformableMultiBodyDynamicsWorld& world) {
  force.setWorld(world);
}
/// Bullet's forces do not know their world.
template <class Force>
void setWorld(Force&, btDeformableMultiBodyDynamicsWorld&) {}

void setMaterial(ElasticForce& force, const ElasticMaterial& material) {
  force.setMaterial(material);
}
template <class Force>
void setMaterial(Force& force, const ElasticMaterial& material) {
  const elastic_detail::Lame lame = elastic_detail::lameOf(material.youngsModulus, material.poissonRatio);
  force.setLameParameters(static_cast<btScalar>(lame.mu), static_cast<btScalar>(lame.lambda));
  setDamping(force, static_cast<btScalar>(material.damping));
}

Status invalid(const std::string& message) {
  return {StatusCode::InvalidOption, message};
}

Status checkSolver(btDeformableBodySolver& solver, const SoftBodyOptions& options) {
  if (options.forceModel != ForceModel::Corotated) {
    if (!solver.isReducedSolver()) return {};
    return refusal("a full body", {kUseDeformableSolver});
  }
  std::vector<std::string> changes;
  if (!deformableSolver(&solver)) {
    changes.push_back(std::string(kUseDeformableSolver) + ", or choose one of Bullet's force models");
  }
  if (options.implicit.value_or(false)) {
    changes.emplace_back("leave SoftBodyOptions::implicit at false: it applies to Bullet's own forces only");
  }
  return refusal("ForceModel::Corotated", changes);
}

/// Rejects gravity that moves bodies farther in a step than numbers of this precision can represent.
Status checkGravity(const btVector3& gravity, const btSoftBody& body) {
  constexpr double kMaxBodyLengths = 1e6;
  double volume = 0.0;
  for (int t = 0; t < body.m_tetras.size(); ++t) volume += static_cast<double>(body.m_tetras[t].m_element_measure);
  const double size = cubeRoot(volume), length = static_cast<double>(gravity.length());
  if (length <= kMaxBodyLengths * size) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "a gravity of %.3g must be finite, and for a body of size %.3g at most %.3g (1e6 body lengths per "
                "second squared)",
                length, size, kMaxBodyLengths * size);
  return invalid(text);
}

/// Rounded to Bullet's precision: the last digits of a double may differ from one processor to another. GCC 12 drops
/// two vectorised conversions, to float and back; hence Veltkamp's splitting.
double inBulletsDigits(double x) {
  if (sizeof(btScalar) == sizeof(double)) return x;
  const double high = x * 536870913.0;  // 2^29 + 1
  return high - (high - x);
}

/// Rounded to Bullet's precision, as offsets from the first node.
std::vector<Eigen::Vector3d> roundedNodes(std::vector<Eigen::Vector3d> nodes) {
  const Eigen::Vector3d first = nodes.front().unaryExpr(&inBulletsDigits);
  for (Eigen::Vector3d& p : nodes) p = first + (p - first).unaryExpr(&inBulletsDigits);
  return nodes;
}

}  // namespace

/// The members of a DeformableBody, in such an order that forces are destroyed before the body on which they act.
struct DeformableBody::Impl final : BodyOwner {
  Impl(btDeformableMultiBodyDynamicsWorld& ofWorld, btDeformableBodySolver& ofSolver, std::unique_ptr<btSoftBody> made)
      : world(&ofWorld),
        solver(&ofSolver),
        hasOwnSolver(deformableSolver(&ofSolver)),
        list(ofSolver.getLagrangianForceArray()),
        body(std::move(made)),
        gravity(ofWorld, *list, !hasOwnSolver, *this) {}

  // The world that the body is in, or was in last.
  btDeformableMultiBodyDynamicsWorld* world;
  btDeformableBodySolver* solver;
  bool hasOwnSolver;  ///< it is a DeformableSolver: the library can tell whether it still exists
  ForceList* list;
  // Collision filters that the body gets when it enters a world: at first Bullet's defaults for a soft body.
  int group = btBroadphaseProxy::DefaultFilter, mask = btBroadphaseProxy::AllFilter;
  std::unique_ptr<btSoftBody> body;
  std::vector<btScalar> masses;  ///< by node: its mass when it is not pinned
  ElasticMaterial material;
  double weightPressure = 1.0;  ///< see the function `weightPressure`
  ForceModel forceModel = ForceModel::Corotated;
  btScalar restMeasure = 0;  ///< when it was added
  BodyGravity gravity;
  std::unique_ptr<btDeformableLagrangianForce> elasticity;
  std::function<void(const ElasticMaterial&)> applyMaterial;  ///< sets the material of `elasticity`
  std::function<void()> moveElasticity;                       ///< tells `elasticity` that the world has changed

  template <class Force, class... Arguments>
  void makeElasticity(Arguments&&... arguments) {
    auto force = std::make_unique<OwnForce<Force>>(*list, std::forward<Arguments>(arguments)...);
    applyMaterial = [to = static_cast<Force*>(force.get())](const ElasticMaterial& now) { setMaterial(*to, now); };
    moveElasticity = [this, to = force.get()] {
      to->setList(*list);
      setWorld(static_cast<Force&>(*to), *world);
    };
    elasticity = std::move(force);
  }
  /// Creates the force of the body's material.
  /// linear, quadratic  the body's tets, and paintedDamping: not used by Bullet's forces
  void makeElasticity(const SoftBodyOptions& options, const elastic_detail::RestTets& linear,
                      const std::vector<double>& paintedDamping, std::vector<QuadraticShape> quadratic);
  void apply(const ElasticMaterial& now) {
    assert(applyMaterial);
    material = now;
    applyMaterial(now);
    body->activate();
  }
  Status set(const ElasticMaterial& now) {
    Status status = checkMaterial(now);
    if (status.ok()) {
      const elastic_detail::MaterialChanges none, &changes = corotated() ? corotated()->body().changes : none;
      status = checkStiffness(*body, now, changes);
    }
    if (status.ok()) apply(now);
    return status;
  }
  /// Calls change(what the owner has set) of a corotated body and, if it succeeds, gives the result to the tets.
  template <class Change>
  Status changeMaterial(const char* what, Change&& change) {
    ElasticForce* elastic = corotated();
    if (!elastic) {
      return {StatusCode::InvalidOption, std::string(what) + " needs ForceModel::Corotated"};
    }
    if (hasOwnSolver && solverLives() && isWithinStep(static_cast<const DeformableSolver&>(*solver))) {
      return invalid(std::string(what) + ": within a step; call it between two steps");
    }
    Status status = change(*elastic);
    if (status.ok()) body->activate();
    return status;
  }
  /// The same, and gives what the owner has set to the tets.
  template <class Change>
  Status changeSettings(const char* what, Change&& change) {
    return changeMaterial(what, [&](ElasticForce& elastic) {
      Status status = change(elastic.body().changes);
      if (status.ok()) elastic.applyChanges();
      return status;
    });
  }
  /// The same for settings by which the body must not become too stiff.
  template <class Change>
  Status changeStiffness(const char* what, Change&& change) {
    return changeSettings(what, [&](auto& changes) {
      return changes.tryChange(change, [&](const auto& changed) { return checkStiffness(*body, material, changed); });
    });
  }
  /// The same for the shapes at rest alone.
  template <class Change>
  Status changeShapes(const char* what, Change&& change) {
    return changeMaterial(what, [&](ElasticForce& elastic) {
      Status status = change(elastic.body().changes);
      if (status.ok()) elastic.applyShapes();
      return status;
    });
  }
  void enter();
  void moveTo(btDeformableMultiBodyDynamicsWorld& to);
  void serialize(WorldStream& stream) override;
  void leaveWithoutSolver();
  bool isInAWorld() const { return body->getBroadphaseHandle() != nullptr; }
  bool isInItsWorld() const { return isInAWorld() && body->getSoftBodySolver() == solver; }
  /// True if the forces are still in the world. Removing the body from the world removes it from its forces, and
  /// elasticity drops a body with tets that it cannot simulate.
  bool isActedOn() const {
    return isInItsWorld() && gravity.m_softBodies.size() > 0 && elasticity->m_softBodies.size() > 0;
  }
  /// Null with one of Bullet's forces.
  ElasticForce* corotated() {
    return forceModel == ForceModel::Corotated ? static_cast<ElasticForce*>(elasticity.get()) : nullptr;
  }
  /// Ok if its pressure may be set now.
  Status checkPressed(const std::string& call);
  /// Ok if the body may be put elsewhere now.
  Status checkIsPlaced(const std::string& call) const;
  /// Wakes bodies on or beside this one after it has gone.
  void wakeNeighbours();
  bool solverLives() const { return !hasOwnSolver || deformableSolver(solver); }
  Status checkNode(int node) const {
    if (node >= 0 && node < static_cast<int>(masses.size())) return {};
    return {StatusCode::IndexOutOfRange, "node " + std::to_string(node) + " does not exist in a cage of " +
                                             std::to_string(masses.size()) + " nodes"};
  }
};

DeformableBody::DeformableBody(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<DeformableBody>> DeformableBody::add(btDeformableMultiBodyDynamicsWorld& world, const Cage& cage,
                                                            const SoftBodyOptions& given) {
  if (Status status = validateAttributes(cage); !status.ok()) return status;
  const SoftBodyOptions options = withCageDefaults(cage, given);
  if (options.forceModel == ForceModel::MassSpring) {
    return invalid(
        "mass-spring bodies are not stable in the deformable world; choose neo-Hookean or linear elasticity, or add "
        "the body to a btSoftRigidDynamicsWorld");
  }
  btDeformableBodySolver& solver = solverOf(world);
  if (Status status = checkSolver(solver, options); !status.ok()) return status;
  Result<BuiltBody> built = buildBody(cage, world.getWorldInfo(), options);
  if (!built.ok()) return built.status();
  std::unique_ptr<btSoftBody>& body = built.value().body;
  const std::vector<double>& masses = built.value().masses;
  const bool corotated = options.forceModel == ForceModel::Corotated;
  Result<elastic_detail::RestTets> rest = corotated ? restTetsOf(*body) : elastic_detail::RestTets();
  if (!rest.ok()) return rest.status();
  rest.value().nodes = roundedNodes(cage.mesh.nodes);
  Result<std::vector<QuadraticShape>> quadratic =
      corotated ? quadraticShapes(cage, given.stiffnessScale) : std::vector<QuadraticShape>();
  if (!quadratic.ok()) return quadratic.status();
  const double pressure = weightPressure(cage, masses, static_cast<double>(world.getGravity().length()));
  const ElasticMaterial material{options.youngsModulus
                                     ? *options.youngsModulus
                                     : defaultYoungsModulus(cage.mesh, options, masses, pressure, !corotated),
                                 options.poissonRatio, options.stiffnessDamping};
  if (Status status = checkMaterial(material); !status.ok()) return status;
  const elastic_detail::MaterialChanges painted(cage.mesh.tetCount(), cage.paintedDamping);
  if (Status status = checkStiffness(*body, material, painted); !status.ok()) return status;
  if (Status status = checkGravity(world.getGravity(), *body); !status.ok()) return status;

  auto impl = std::make_unique<Impl>(world, solver, std::move(body));
  for (const double m : masses) impl->masses.push_back(static_cast<btScalar>(m));
  impl->material = material;
  impl->weightPressure = pressure;
  std::unique_ptr<DeformableBody> made(new DeformableBody(std::move(impl)));
  made->impl_->makeElasticity(options, rest.value(), cage.paintedDamping, std::move(quadratic).value());
  made->impl_->enter();
  if (options.configureWorld) {
    world.setUseProjection(true);
    if (options.implicit) world.setLineSearch(false);
    if (options.implicit) world.setImplicit(*options.implicit);
  }
  return made;
}

/// Adds the body, unless it is already there, and its forces to the world. Whatever may run out of memory comes first:
/// after that, nothing throws.
void DeformableBody::Impl::enter() {
  assert(elasticity);
  btDispatcher& dispatcher = *world->getDispatcher();
  if (forceModel == ForceModel::Corotated && !isKnownNotToBe<btCollisionDispatcher>(dispatcher)) {
    registerContactAlgorithms(static_cast<btCollisionDispatcher&>(dispatcher));
  }
  if (!isInAWorld()) world->addSoftBody(body.get(), group, mask);
  for (btDeformableLagrangianForce* force : {static_cast<btDeformableLagrangianForce*>(&gravity), elasticity.get()}) {
    force->setIndices(solver->getIndices());
  }
  addToList(*list, gravity, *elasticity, *body);
  if (forceModel != ForceModel::Corotated) return;
  Access<DeformableSolver>::requireOwnSolve(static_cast<DeformableSolver&>(*solver), *world);
}

void DeformableBody::Impl::makeElasticity(const SoftBodyOptions& options, const elastic_detail::RestTets& linear,
                                          const std::vector<double>& paintedDamping,
                                          std::vector<QuadraticShape> quadratic) {
  forceModel = options.forceModel;
  restMeasure = restMeasureOf(*body);
  switch (options.forceModel) {
    case ForceModel::LinearElasticity:
      makeElasticity<btDeformableLinearElasticityForce>();
      applyMaterial(material);
      return;
    case ForceModel::NeoHookean:
      makeElasticity<btDeformableNeoHookeanForce>();
      applyMaterial(material);
      return;
    default:
      makeElasticity<ElasticForce>(*world, *body, linear, material, options.stiffnessScale, paintedDamping,
                                   std::move(quadratic),
                                   SolverSettings{options.solverTolerance, options.maxIterations});
  }
}

/// Masses of pinned nodes, and the material.
void DeformableBody::Impl::serialize(WorldStream& stream) {
  for (std::size_t n = 0; n < masses.size(); ++n) {
    if (static_cast<int>(n) < body->m_nodes.size() && body->m_nodes[static_cast<int>(n)].m_im == 0) stream(masses[n]);
  }
  ElasticMaterial now = material;
  stream(now.youngsModulus, now.poissonRatio, now.damping);
  if (now == material) return;
  material = now;
  applyMaterial(now);
}

ForceModel DeformableBody::forceModel() const {
  return impl_->forceModel;
}

SolverPath DeformableBody::solverPath() const {
  if (!impl_->isActedOn()) return SolverPath::None;
  return impl_->forceModel == ForceModel::Corotated ? SolverPath::Solver : SolverPath::Bullet;
}

/// Removes the body as the world would, but does not tell the solver, which was destroyed before the world.
void DeformableBody::Impl::leaveWithoutSolver() {
  assert(isInItsWorld());
  world->getSoftBodyArray().remove(body.get());
  world->btCollisionWorld::removeCollisionObject(body.get());
}

DeformableBody::~DeformableBody() {
  // The body was removed from the world, by the application or by the world's destructor: nothing in the world needs an
  // update, and it may not exist any more.
  if (!impl_->isInAWorld()) return;
  if (!impl_->isInItsWorld()) {
    (void)impl_->body.release();  // another world still contains it
    return;
  }
  if (!impl_->solverLives()) {
    impl_->leaveWithoutSolver();
    return;
  }
  removeFromList(*impl_->list, &impl_->gravity);
  removeFromList(*impl_->list, impl_->elasticity.get());
  impl_->world->removeSoftBody(impl_->body.get());
}

/// The body is in no world, or in this one without its forces. Its former world may have been destroyed, and another
/// one be at its address.
void DeformableBody::Impl::moveTo(btDeformableMultiBodyDynamicsWorld& to) {
  assert(!isActedOn());
  if (isInItsWorld()) {
    removeFromList(*list, &gravity);
    removeFromList(*list, elasticity.get());
  }
  gravity.m_softBodies.clear();
  elasticity->m_softBodies.clear();
  world = &to;
  solver = &solverOf(to);
  hasOwnSolver = deformableSolver(solver);
  list = solver->getLagrangianForceArray();
  body->m_worldInfo = &to.getWorldInfo();
  gravity.setWorld(to, *list, !hasOwnSolver);
  moveElasticity();
  BodyWithTrees& own = *bodyWithTrees(*body);
  own.setMovesCountedBy(nullptr);
  if (const auto contacts = BodyChannel::of(own).surfaceContacts().lock()) contacts->setDispatcher(to.getDispatcher());
}

void DeformableBody::removeFromWorld() {
  if (!impl_->isInItsWorld()) return;
  assert(impl_->solverLives());
  impl_->wakeNeighbours();
  impl_->group = body().getBroadphaseHandle()->m_collisionFilterGroup;
  impl_->mask = body().getBroadphaseHandle()->m_collisionFilterMask;
  impl_->world->removeSoftBody(impl_->body.get());
}

Status DeformableBody::addToWorld(btDeformableMultiBodyDynamicsWorld& world) {
  if (impl_->isActedOn()) return invalid("the body is already in a world: call removeFromWorld first");
  const auto& inWorld = world.getSoftBodyArray();
  const bool isThere = inWorld.findLinearSearch(impl_->body.get()) < inWorld.size();
  if (impl_->isInAWorld() && !isThere) return invalid("the body is in another world: remove it there first");
  SoftBodyOptions options;
  options.forceModel = impl_->forceModel;
  if (Status status = checkSolver(solverOf(world), options); !status.ok()) return status;
  if (Status status = checkGravity(world.getGravity(), body()); !status.ok()) return status;
  impl_->moveTo(world);
  impl_->enter();
  impl_->group = btBroadphaseProxy::DefaultFilter;
  impl_->mask = btBroadphaseProxy::AllFilter;
  body().activate();
  return {};
}

btSoftBody& DeformableBody::body() {
  return *impl_->body;
}
const btSoftBody& DeformableBody::body() const {
  return *impl_->body;
}
double DeformableBody::youngsModulus() const {
  return impl_->material.youngsModulus;
}
double DeformableBody::relativeStiffness() const {
  return impl_->material.youngsModulus / impl_->weightPressure;
}
double DeformableBody::poissonRatio() const {
  return impl_->material.poissonRatio;
}
double DeformableBody::stiffnessDamping() const {
  return impl_->material.damping;
}

Status DeformableBody::setYoungsModulus(double pressure) {
  return impl_->set({pressure, poissonRatio(), stiffnessDamping()});
}

Status DeformableBody::setPoissonRatio(double ratio) {
  return impl_->set({youngsModulus(), ratio, stiffnessDamping()});
}

Status DeformableBody::setStiffnessDamping(double seconds) {
  return impl_->set({youngsModulus(), poissonRatio(), seconds});
}

Status DeformableBody::setPlasticity(const Plasticity& plasticity) {
  return impl_->changeSettings("plasticity", [&](auto& changes) { return changes.setPlasticity(plasticity); });
}

Status DeformableBody::endPlasticity() {
  return impl_->changeSettings("plasticity", [](auto& changes) {
    changes.endPlasticity();
    return Status();
  });
}

Status DeformableBody::resetPlasticFlow() {
  return impl_->changeMaterial("plasticity", [](ElasticForce& elastic) {
    elastic.body().dynamics->tets()->forgetFlow();
    return Status();
  });
}

std::vector<double> DeformableBody::plasticStrains() const {
  ElasticForce* elastic = impl_->corotated();
  if (!elastic) return std::vector<double>(static_cast<std::size_t>(body().m_tetras.size()), 0.0);
  return elastic->body().dynamics->tets()->plasticStrains(elastic->body().tetCount);
}

Status DeformableBody::setGrowth(double length) {
  return impl_->changeShapes("growth", [&](auto& changes) { return changes.setGrowth(length); });
}

Status DeformableBody::setGrowth(const std::vector<double>& lengths) {
  return impl_->changeShapes("growth", [&](auto& changes) { return changes.setGrowth(lengths); });
}

Status DeformableBody::setGrowthTensors(const std::vector<std::array<double, 9>>& deformations) {
  return impl_->changeShapes("growth", [&](auto& changes) { return changes.setGrowthTensors(deformations); });
}

Status DeformableBody::setStiffnessScale(const std::vector<double>& factors) {
  return impl_->changeStiffness("stiffness by tet", [&](auto& changes) { return changes.setStiffnessScale(factors); });
}

Status DeformableBody::setDampingScale(const std::vector<double>& factors) {
  return impl_->changeStiffness("damping by tet", [&](auto& changes) { return changes.setDampingScale(factors); });
}

Status DeformableBody::addFibres(const Fibres& fibres) {
  return impl_->changeStiffness("fibres", [&](auto& changes) { return changes.addFibres(fibres); });
}

Result<int> DeformableBody::addMuscle(const Muscle& muscle) {
  int number = 0;
  Status status = impl_->changeShapes("a muscle", [&](auto& changes) {
    const Result<int> added = changes.addMuscle(muscle);
    if (added.ok()) number = added.value();
    return added.ok() ? Status() : added.status();
  });
  if (!status.ok()) return status;
  return number;
}

Status DeformableBody::setActivation(int muscle, double activation) {
  if (activation > 0.0 && this->activation(muscle) == activation) return {};
  return impl_->changeShapes("a muscle", [&](auto& changes) { return changes.setActivation(muscle, activation); });
}

double DeformableBody::activation(int muscle) const {
  ElasticForce* elastic = impl_->corotated();
  return elastic ? elastic->body().changes.activation(muscle) : 0.0;
}

Status DeformableBody::setGravity(const btVector3& gravity) {
  if (Status status = checkGravity(gravity, body()); !status.ok()) return status;
  impl_->gravity.set(gravity);
  body().activate();
  return {};
}

void DeformableBody::followWorldGravity() {
  impl_->gravity.set({});
  body().activate();
}

bool DeformableBody::isPinned(int node) const {
  assert(impl_->checkNode(node).ok());
  return body().m_nodes[node].m_im == 0;
}

Status DeformableBody::setPinned(int node, bool pinned) {
  if (Status status = impl_->checkNode(node); !status.ok()) return status;
  btSoftBody::Node& pinnedNode = body().m_nodes[node];
  btScalar& mass = impl_->masses[static_cast<std::size_t>(node)];
  if (pinned) {
    if (pinnedNode.m_im > 0) mass = 1 / pinnedNode.m_im;
    for (btVector3* rate : {&pinnedNode.m_v, &pinnedNode.m_vn, &pinnedNode.m_splitv}) rate->setZero();
    body().setMass(node, 0);
  } else if (isPinned(node)) {
    body().setMass(node, mass);
  }
  body().activate();
  return {};
}

Status DeformableBody::setPinnedPosition(int node, const btVector3& position) {
  if (Status status = impl_->checkNode(node); !status.ok()) return status;
  if (!isPinned(node)) {
    return invalid("node " + std::to_string(node) + " is not pinned: call setPinned first");
  }
  if (!toEigen(position).allFinite()) {
    return {StatusCode::NonFinite, "the position of pinned node " + std::to_string(node) + " is not finite"};
  }
  body().m_nodes[node].m_x = position;
  if (BodyWithTrees* own = bodyWithTrees(body())) own->countMove();
  body().activate();
  return {};
}

Status DeformableBody::Impl::checkIsPlaced(const std::string& call) const {
  if (!isInItsWorld()) return invalid(call + ": the body is not in its world");
  if (!hasOwnSolver || !isWithinStep(static_cast<const DeformableSolver&>(*solver))) return {};
  return invalid(call + ": within a step; call it between two steps");
}

void DeformableBody::Impl::wakeNeighbours() {
  struct Waker : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
      static_cast<btCollisionObject*>(proxy->m_clientObject)->activate();
      return true;
    }
  } waker;
  const btBroadphaseProxy& own = *body->getBroadphaseHandle();
  world->getBroadphase()->aabbTest(own.m_aabbMin, own.m_aabbMax, waker);
}

Status DeformableBody::teleport(const btTransform& motion) {
  if (Status status = impl_->checkIsPlaced("teleport"); !status.ok()) return status;
  if (!isRigid(motion)) {
    return invalid(
        "teleport: the transform is not a rigid motion: it is not finite, scales, shears or mirrors, or leads too far");
  }
  btSoftBody& soft = body();
  ElasticForce* elastic = impl_->corotated();
  const Placement placement(motion);
  const auto moveNodes = [&] { carryNodes(soft, elastic ? elastic->body().dynamics.get() : nullptr, placement); };
  impl_->wakeNeighbours();
  if (impl_->hasOwnSolver) {
    Access<DeformableSolver>::teleport(static_cast<DeformableSolver&>(*impl_->solver), soft, placement, moveNodes);
  } else {
    moveNodes();
  }
  if (BodyWithTrees* own = bodyWithTrees(soft)) own->countMove();
  soft.activate();
  return {};
}

Status DeformableBody::reset() {
  if (Status status = impl_->checkIsPlaced("reset"); !status.ok()) return status;
  BodyWithTrees& own = *bodyWithTrees(body());
  ElasticForce* elastic = impl_->corotated();
  const bool same = own.createdAt().size() == static_cast<std::size_t>(own.m_nodes.size()) &&
                    restMeasureOf(own) == impl_->restMeasure && (!elastic || elastic->body().hasItsRestShapes());
  if (!same)
    return invalid("reset: the body was scaled, or its nodes or tets changed, since it was added; add it anew");
  impl_->wakeNeighbours();
  if (impl_->hasOwnSolver) Access<DeformableSolver>::reset(static_cast<DeformableSolver&>(*impl_->solver), own);
  own.returnToStart();
  if (elastic) elastic->reset();
  own.activate();
  return {};
}

// ---- pressure

Status DeformableBody::Impl::checkPressed(const std::string& call) {
  if (!corotated()) return invalid(call + ": needs ForceModel::Corotated; this body has one of Bullet's force models");
  if (!corotated()->body().hasItsRestShapes()) return invalid(call + ": the body's nodes or tets have been changed");
  const bool within = isInItsWorld() && isWithinStep(static_cast<const DeformableSolver&>(*solver));
  return within ? invalid(call + ": within a step; call it between two steps") : Status();
}

Status DeformableBody::setPressure(double pressure) {
  if (Status status = impl_->checkPressed("setPressure"); !status.ok()) return status;
  if (Status status = checkPressure(body(), pressure); !status.ok()) return status;
  ForcedBody& forced = impl_->corotated()->body();
  if (Status status = forced.pressure.setConstant(pressure, *forced.dynamics); !status.ok()) return status;
  body().activate();
  return {};
}

Status DeformableBody::setGas(double pressure, double outside) {
  if (Status status = impl_->checkPressed("setGas"); !status.ok()) return status;
  if (Status status = checkGas(body(), pressure, outside); !status.ok()) return status;
  ForcedBody& forced = impl_->corotated()->body();
  if (Status status = forced.pressure.setGas(pressure, outside, forced.probe(), *forced.dynamics); !status.ok())
    return status;
  body().activate();
  return {};
}

double DeformableBody::pressure() const {
  if (!impl_->corotated() || !impl_->corotated()->body().hasOwnCounts()) return 0.0;
  ForcedBody& forced = impl_->corotated()->body();
  return forced.pressure.pressure(forced.probe(), *forced.dynamics);
}

double DeformableBody::volume() const {
  if (!impl_->corotated() || !impl_->corotated()->body().hasOwnCounts()) return 0.0;
  ForcedBody& forced = impl_->corotated()->body();
  return forced.pressure.volume(forced.probe(), *forced.dynamics);
}

namespace {

Result<elastic_detail::PressureSurface> embeddedSurface(const TriangleMesh& mesh, const Embedding& embedding,
                                                        const Dynamics& dynamics) {
  if (embedding.vertexCount() != mesh.vertexCount() || embedding.nodeCount() != dynamics.nodeCount()) {
    return Status{StatusCode::SizeMismatch, "the mesh, its embedding and the body do not belong together"};
  }
  if (Status status = validate(mesh); !status.ok()) return status;
  std::vector<std::array<double, 3>> positions;
  std::vector<elastic_detail::SurfaceVertex> vertices;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const EmbeddedPoint<double> point = embedding.at(v);
    const Eigen::Vector3d& x = mesh.positions[v];
    positions.push_back({x[0], x[1], x[2]});
    auto& vertex = vertices.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) vertex[k] = {point.nodes[k], point.weights[k]};
  }
  const auto partOf = [&](int vertex) {
    return dynamics.componentOf(static_cast<std::size_t>(vertices[static_cast<std::size_t>(vertex)][0].first));
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (partOf(a) != partOf(b) || partOf(b) != partOf(c))
      return invalid("the mesh joins parts of the cage that are not connected");
  }
  return elastic_detail::PressureSurface::ofMesh(positions, mesh.triangles, vertices);
}

}  // namespace

Status DeformableBody::setPressureSurface(const TriangleMesh& mesh, const Embedding& embedding) {
  if (Status status = impl_->checkPressed("setPressureSurface"); !status.ok()) return status;
  ForcedBody& forced = impl_->corotated()->body();
  std::shared_ptr<elastic_detail::PressureSurface> surface;
  if (!embedding.empty() || mesh.vertexCount() > 0 || !mesh.triangles.empty()) {
    Result<elastic_detail::PressureSurface> made = embeddedSurface(mesh, embedding, *forced.dynamics);
    if (!made.ok()) return {made.status().code, "setPressureSurface: " + made.status().message};
    surface = std::make_shared<elastic_detail::PressureSurface>(std::move(made).value());
  }
  if (Status status = forced.pressure.setSurface(std::move(surface), forced.probe(), *forced.dynamics); !status.ok())
    return status;
  body().activate();
  return {};
}

void DeformableBody::preparePressureSurface(std::shared_ptr<const TriangleMesh> mesh, const Embedding& embedding) {
  if (!impl_->corotated() || !mesh) return;
  ForcedBody& forced = impl_->corotated()->body();
  forced.pressure.offerSurface(
      [&forced, mesh = std::move(mesh), embedding] { return embeddedSurface(*mesh, embedding, *forced.dynamics); });
}

}  // namespace tetskin
