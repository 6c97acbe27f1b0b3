// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <tetskin/bullet/src/base/body_elements.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/body/body_in_world.h>
#include <tetskin/solver/src/search/contact_algorithm.h>

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {
namespace {

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

}  // namespace

Status checkGravity(const btVector3& gravity, const btSoftBody& body) {
  constexpr double kMaxBodyLengths = 1e6;  // per second squared
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

template <class Force, class... Arguments>
void BodyInWorld::makeElasticity(Arguments&&... arguments) {
  auto force = std::make_unique<OwnForce<Force>>(*list, std::forward<Arguments>(arguments)...);
  applyMaterial = [to = static_cast<Force*>(force.get())](const ElasticMaterial& now) { setMaterial(*to, now); };
  moveElasticity = [this, to = force.get()] {
    to->setList(*list);
    setWorld(static_cast<Force&>(*to), *world);
  };
  elasticity = std::move(force);
}

/// Adds the body, unless it is already there, and its forces to the world. Whatever may run out of memory comes first:
/// after that, nothing throws.
void BodyInWorld::enter() {
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

void BodyInWorld::makeElasticity(const SoftBodyOptions& options, const elastic_detail::RestTets& linear,
                                 const std::vector<double>& paintedDamping, std::vector<QuadraticShape> quadratic) {
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
void BodyInWorld::serialize(WorldStream& stream) {
  for (std::size_t n = 0; n < masses.size(); ++n) {
    if (static_cast<int>(n) < body->m_nodes.size() && body->m_nodes[static_cast<int>(n)].m_im == 0) stream(masses[n]);
  }
  ElasticMaterial now = material;
  stream(now.youngsModulus, now.poissonRatio, now.damping);
  if (now == material) return;
  material = now;
  applyMaterial(now);
}

/// Removes the body as the world would, but does not tell the solver, which was destroyed before the world.
void BodyInWorld::leaveWithoutSolver() {
  assert(isInItsWorld());
  world->getSoftBodyArray().remove(body.get());
  world->btCollisionWorld::removeCollisionObject(body.get());
}

/// The body is in no world, or in this one without its forces. Its former world may have been destroyed, and another
/// one be at its address.
void BodyInWorld::moveTo(btDeformableMultiBodyDynamicsWorld& to) {
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

Status BodyInWorld::checkIsPlaced(const std::string& call) const {
  if (!isInItsWorld()) return invalid(call + ": the body is not in its world");
  if (!hasOwnSolver || !isWithinStep(static_cast<const DeformableSolver&>(*solver))) return {};
  return invalid(call + ": within a step; call it between two steps");
}

void BodyInWorld::wakeNeighbours() {
  struct Waker : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
      static_cast<btCollisionObject*>(proxy->m_clientObject)->activate();
      return true;
    }
  } waker;
  const btBroadphaseProxy& own = *body->getBroadphaseHandle();
  world->getBroadphase()->aabbTest(own.m_aabbMin, own.m_aabbMax, waker);
}

Status BodyInWorld::checkPressed(const std::string& call) {
  if (!corotated()) return invalid(call + ": needs ForceModel::Corotated; this body has one of Bullet's force models");
  if (!corotated()->body().hasItsRestShapes()) return invalid(call + ": the body's nodes or tets have been changed");
  const bool within = isInItsWorld() && isWithinStep(static_cast<const DeformableSolver&>(*solver));
  return within ? invalid(call + ": within a step; call it between two steps") : Status();
}

}  // namespace tetskin::bullet_detail
