// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The functions that Bullet calls. Their stages are in step.cpp.
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/src/base/run_by_size.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/contact_filter.h>
#include <tetskin/solver/src/base/destroy_all.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/search/body_contacts.h>
#include <tetskin/solver/src/step/step.h>

#include <cassert>
#include <string>

namespace tetskin {
namespace {

/// counter  null if Bullet's own code solves: it also moves sleeping bodies that have a velocity, so all bodies would
///          count as moved in each step
void setMovesCounted(const btAlignedObjectArray<btSoftBody*>& bodies, const btSoftBodySolver* counter) {
  for (int b = 0; b < bodies.size(); ++b) {
    if (auto* own = bodyWithTrees(*bodies[b])) own->setMovesCountedBy(counter);
  }
}

void countMoves(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (int b = 0; b < bodies.size(); ++b) {
    if (auto* own = bodyWithTrees(*bodies[b])) own->countMove();
  }
}

}  // namespace

bool bullet_detail::isWithinStep(const DeformableSolver& solver) {
  const auto& impl = Access<DeformableSolver>::impl(solver);
  return impl.inStep() || impl.inSimulation;
}

DeformableSolver::DeformableSolver() : impl_(std::make_unique<Impl>(*this)) {
  m_useProjection = true;
  setImplicit(false);
  setLineSearch(false);
  m_dt = 0;
}
DeformableSolver::~DeformableSolver() = default;

void DeformableSolver::setThreads(ParallelFor* threads) {
  impl_->threads = threads;
}
void DeformableSolver::setDeterministic(bool on) {
  impl_->deterministic = on;
}
bool DeformableSolver::deterministic() const {
  return impl_->deterministic;
}
Status DeformableSolver::setSleepAfter(btScalar seconds) {
  if (!(seconds >= 0)) {
    return {StatusCode::InvalidOption, "sleepAfter is " + std::to_string(seconds) + ", and must be at least 0 seconds"};
  }
  impl_->stillness.sleepAfter = seconds;
  return {};
}
btScalar DeformableSolver::sleepAfter() const {
  return impl_->stillness.sleepAfter;
}
DeformableSolver::Impl& Access<DeformableSolver>::impl(const DeformableSolver& solver) {
  return *solver.impl_;
}
void Access<DeformableSolver>::requireOwnSolve(DeformableSolver& solver, btDeformableMultiBodyDynamicsWorld& world) {
  solver.requireOwnSolve();
  solver.impl_->know(world);
}
void Access<DeformableSolver>::addLoads(DeformableSolver& solver, btSoftBody& body, NodePushes forces, int steps) {
  solver.requireOwnSolve();
  solver.impl_->loads.add(body, std::move(forces), steps);
}
void DeformableSolver::setNodeNormals(bool on) {
  impl_->nodeNormals = on;
}
void DeformableSolver::requireOwnSolve() {
  impl_->always = true;
}
bool DeformableSolver::ownSolveActive() const {
  return impl_->always || (m_useProjection && !m_lineSearch && !m_implicit);
}
int DeformableSolver::iterations() const {
  return impl_->iterations;
}
int DeformableSolver::linearSolves() const {
  return impl_->passes;
}
int DeformableSolver::unconvergedSystems() const {
  return impl_->unconverged;
}
const StepTimes& DeformableSolver::stepTimes() const {
  return impl_->clock.times();
}

/// Bullet calls this when a step begins and, with a negative time, when a body has left the world.
void DeformableSolver::reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) {
  impl_->loads.dropAllBut(softBodies);
  if (!(dt > 0)) return impl_->dropRemoved(softBodies);
  impl_->clock.restart();
  if (impl_->rigidForces) impl_->rigidForces->begin();
  impl_->gather(softBodies, dt);
  setMovesCounted(softBodies, impl_->solving ? this : nullptr);
  impl_->clock.end(&StepTimes::prediction);
  updateSoftBodies();
}

void DeformableSolver::updateSoftBodies() {
  if (impl_->nodeNormals) btDeformableBodySolver::updateSoftBodies();
}

void DeformableSolver::predictMotion(btScalar dt) {
  if (!(dt > 0)) return;  // as of a world that is stepped by a negative time: there is no step
  Impl& impl = *impl_;
  impl.clock.restart();
  if (impl.solving != ownSolveActive()) {
    // The world's settings may have changed since the last step.
    impl.solving = ownSolveActive();
    impl.collect(impl.all);
    impl.assign();
  }
  impl.solving ? impl.predict() : btDeformableBodySolver::predictMotion(dt);
  impl.noteObjects();
  impl.clock.end(&StepTimes::prediction);
}

/// Bullet calls this for a body and a rigid object with overlapping boxes, to find their contacts.
void DeformableSolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* object) {
  if (impl_->solving) {
    if (!body->isActive() || !collidesWithRigid(*body, *object->getCollisionObject())) return;
    const SolvedBody* solved = impl_->bodies.find(body);
    // Usually the algorithm of the pair has called it already, but the dispatcher may not be one of Bullet's.
    if (solved && !solved->byBullet) return channelOf(*body)->nodeContacts()->collide(*object);
    impl_->obstacleChanges.syncRigidObject(*body, *object);
  }
  btDeformableBodySolver::processCollision(body, object);
}

void DeformableSolver::setupDeformableSolve(bool implicit) {
  btDeformableBodySolver::setupDeformableSolve(implicit && !impl_->solving);
}

/// This solver solves for the rows; Bullet's own constraints of the same nodes would apply them twice. Collision
/// detection has run since the prediction.
void DeformableSolver::setConstraints(const btContactSolverInfo& info) {
  impl_->dropRemovedObjects();
  impl_->searchWaiting();
  impl_->clock.end(&StepTimes::rigidSearch);
  btDeformableBodySolver::setConstraints(info);
  if (!impl_->solving) return;
  impl_->jointImpulses.begin(impl_->bodies.worlds());
  btDeformableContactProjection& projection = m_objective->m_projection;
  assert(static_cast<std::size_t>(projection.m_nodeRigidConstraints.size()) >= impl_->bodies.bodies().size());
  for (std::size_t b = 0; b < impl_->bodies.bodies().size(); ++b) {
    if (!impl_->bodies.bodies()[b].elastic) continue;
    const auto at = static_cast<int>(b);
    destroyAll(projection.m_nodeRigidConstraints[at]);
    destroyAll(projection.m_nodeAnchorConstraints[at]);
    destroyAll(projection.m_faceRigidConstraints[at]);
  }
}

/// A world without projection calls this instead.
void DeformableSolver::setLagrangeMultiplier() {
  impl_->solving ? setProjection() : btDeformableBodySolver::setLagrangeMultiplier();
}

void DeformableSolver::solveDeformableConstraints(btScalar dt) {
  if (!(dt > 0)) return;
  Impl& impl = *impl_;
  // A callback has made a whole step within this one, whose prediction is gone: it goes on without forces.
  if (impl.solving && !impl.inStep()) return;
  impl.clock.restart();
  if (impl.solving) {
    impl.assemble();
    impl.clock.end(&StepTimes::rows);
    impl.solve();
    impl.finishContacts();
    impl.writeBack();
  } else {
    impl.iterations = impl.passes = impl.unconverged = 0;
    btDeformableBodySolver::solveDeformableConstraints(dt);
  }
  impl.clock.end(&StepTimes::system);
}

void DeformableSolver::applyTransforms(btScalar dt) {
  if (!(dt > 0)) return;
  Impl& impl = *impl_;
  impl.hidden.show(m_softBodies);
  // A body that has fallen asleep since the step began was not solved for: its velocities must not be used.
  for (int i = 0; i < m_softBodies.size(); ++i) {
    btSoftBody& body = *m_softBodies[i];
    if (body.isActive() || !impl.solving) continue;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      body.m_nodes[n].m_v.setZero();
      body.m_nodes[n].m_splitv.setZero();
    }
  }
  impl.driven.beforeIntegration(m_softBodies);
  for (SolvedBody& body : impl.bodies.bodies()) {
    if (impl.driven.knows(*body.body)) impl.listForeignNodes(body);
  }
  btDeformableBodySolver::applyTransforms(dt);
  impl.refinePositions(dt);
  impl.driven.end(m_softBodies, dt);
  setMovesCounted(m_softBodies, impl.solving ? this : nullptr);
  countMoves(m_softBodies);
  impl.endStep(m_softBodies);
}

void DeformableSolver::Impl::endStep(const btAlignedObjectArray<btSoftBody*>& world) {
  hidden.show(world);
  rigids.paths().endStep();
  if (rigidForces) rigidForces->end();
  stage = Stage::Between;
}

}  // namespace tetskin
