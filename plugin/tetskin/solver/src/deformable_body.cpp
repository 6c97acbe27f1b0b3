// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_elements.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/body/body_in_world.h>
#include <tetskin/solver/src/body/default_stiffness.h>

#include <cassert>
#include <string>
#include <utility>
#include <vector>

namespace tetskin {

using namespace bullet_detail;

namespace {

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

ForceModel DeformableBody::forceModel() const {
  return impl_->forceModel;
}

SolverPath DeformableBody::solverPath() const {
  if (!impl_->isActedOn()) return SolverPath::None;
  return impl_->forceModel == ForceModel::Corotated ? SolverPath::Solver : SolverPath::Bullet;
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

}  // namespace tetskin
