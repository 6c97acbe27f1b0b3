// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A step. Bullet's world calls, in this order:
//   reinitialize                which bodies are awake
//   predictMotion               other forces' impulses; the elastic solve, short if contacts are to be expected
//                               (solver_prediction.cpp)
//   (detection and solve of contacts, by Bullet, with the inverse diagonal blocks for masses of nodes)
//   solveDeformableConstraints  goes on where nothing was met; else solves again, with what contacts have fixed
//                               (solver_contacts.cpp, solver_solve.cpp)
//   applyTransforms             positions
#include <tetskin/bullet/src/solver/solver_contacts.h>
#include <tetskin/bullet/src/solver/solver_parts.h>

namespace tetskin {
namespace {

void resetEffectiveMasses(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (int i = 0; i < bodies.size(); ++i) {
    for (int n = 0; n < bodies[i]->m_nodes.size(); ++n) {
      btSoftBody::Node& node = bodies[i]->m_nodes[n];
      if (node.m_im > 0) node.m_effectiveMass = btMatrix3x3::getIdentity() * (1 / node.m_im);
    }
  }
}

/// Destroys each, as contacts with multibodies own memory. resize(0) would do the same with a contact of no values, for
/// which GCC warns.
template <class Contact>
void destroyAll(btAlignedObjectArray<Contact>& contacts) {
  while (contacts.size() > 0) contacts.pop_back();
}

void clearContacts(btSoftBody& body) {
  destroyAll(body.m_nodeRigidContacts);
  destroyAll(body.m_faceRigidContacts);
  destroyAll(body.m_faceNodeContacts);
  destroyAll(body.m_faceNodeContactsCCD);
}

}  // namespace

bool DeformableSolver::Parts::collect(const btAlignedObjectArray<btSoftBody*>& world) {
  const bool changed = bodies.collect(world, !solving, solver.m_softBodies);
  if (changed) {
    bodies.number(*solver.m_objective);
    solver.m_numNodes = bodies.nodeCount();
    for (VectorStack* v : {&solver.m_dv, &solver.m_ddv, &solver.m_residual, &solver.m_backupVelocity}) {
      v->resize(bodies.nodeCount(), btVector3(0, 0, 0));
    }
  }
  solver.m_objective->m_projection.reinitialize(changed);
  return changed;
}

void DeformableSolver::Parts::assign() {
  if (solving) return bodies.assign(forces());
  bodies.clear();
  resetEffectiveMasses(solver.m_softBodies);
}

/// The world tells its own in each step.
void DeformableSolver::Parts::useOwnSettings() {
  solver.setImplicit(false);
  solver.setLineSearch(false);
  solver.m_useProjection = true;
  solver.setStrainLimiting(true);
}

void DeformableSolver::Parts::forEachBody(void (Parts::*task)(SolvedBody&, ParallelFor*)) {
  auto& list = bodies.bodies();
  ParallelFor* inner = list.size() == 1 ? threads : nullptr;
  runTasks(inner ? nullptr : threads, list.size(), [&](std::size_t k) { (this->*task)(list[k], inner); });
}

DeformableSolver::DeformableSolver() : parts_(std::make_unique<Parts>(*this)) {
  m_useProjection = true;
  setImplicit(false);
  setLineSearch(false);
  m_dt = 0;
}
DeformableSolver::~DeformableSolver() = default;

void DeformableSolver::setThreads(ParallelFor* threads) {
  parts_->threads = threads;
}
void DeformableSolver::setNodeNormals(bool on) {
  parts_->nodeNormals = on;
}
void DeformableSolver::solveAlways() {
  parts_->always = true;
}
bool DeformableSolver::solves() const {
  return parts_->always || (m_useProjection && !m_lineSearch && !m_implicit);
}
int DeformableSolver::iterations() const {
  return parts_->iterations;
}
btScalar DeformableSolver::normalImpulse(const btSoftBody& body, int node) const {
  return parts_->solving ? parts_->bodies.normalImpulse(body, node) : btScalar(0);
}

void DeformableSolver::reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) {
  Parts& parts = *parts_;
  parts.solving = solves();
  parts.hidden.show(softBodies);
  parts.all.copyFromArray(softBodies);
  const bool changed = parts.collect(softBodies);
  if (changed) parts.driven.keepOnly(softBodies);
  if (dt > 0) parts.driven.begin(m_softBodies, dt);  // a removal is no step
  for (int i = 0; i < (changed ? m_numNodes : parts.bodies.awakeCount()); ++i) {
    m_dv[i].setZero();
    m_ddv[i].setZero();
    m_residual[i].setZero();
  }
  if (dt > 0) {
    m_dt = dt;
    m_objective->setDt(dt);
  }
  // They may make a body's dynamics anew.
  for (int i = 0; i < parts.forces().size(); ++i) parts.forces()[i]->reinitialize(changed);
  parts.assign();
  updateSoftBodies();
}

void DeformableSolver::updateSoftBodies() {
  if (parts_->nodeNormals) btDeformableBodySolver::updateSoftBodies();
}

void DeformableSolver::predictMotion(btScalar dt) {
  Parts& parts = *parts_;
  if (parts.solving != solves()) {
    // The world's settings have changed since the step before.
    parts.solving = solves();
    parts.collect(parts.all);
    parts.assign();
  }
  if (!parts.solving) return btDeformableBodySolver::predictMotion(dt);
  parts.useOwnSettings();

  parts.applyOthers();
  for (SolvedBody& of : parts.bodies.bodies()) readNodes(*of.body, false, *of.dynamics);
  parts.forEachBody(&Parts::predict);
  for (SolvedBody& of : parts.bodies.bodies()) {
    parts.writePrediction(of);
    clearContacts(*of.body);
    // Bullet's own also refits the trees of faces.
    if (of.body->m_bUpdateRtCst || meetsByFaces(*of.body)) {
      of.paddedTrees->ready = false;
      predictDeformableMotion(of.body, dt);
    } else {
      parts.predictPositions(of);
    }
  }
}

void DeformableSolver::setupDeformableSolve(bool implicit) {
  btDeformableBodySolver::setupDeformableSolve(implicit && !parts_->solving);
}

/// What a world without projection asks for.
void DeformableSolver::setLagrangeMultiplier() {
  parts_->solving ? setProjection() : btDeformableBodySolver::setLagrangeMultiplier();
}

void DeformableSolver::solveDeformableConstraints(btScalar dt) {
  Parts& parts = *parts_;
  parts.iterations = 0;
  if (!parts.solving) return btDeformableBodySolver::solveDeformableConstraints(dt);

  auto& bodies = parts.bodies.bodies();
  const btDeformableContactProjection& projection = m_objective->m_projection;
  for (SolvedBody& of : bodies) of.dynamics->matrix().free();
  for (SolvedBody& of : bodies) parts.readContacts(of);
  parts.addOthers();
  parts.tieRigids();
  addDynamicFriction(projection, parts.ties, parts.bodies, m_residual);
  fixContacts(projection, parts.ties, parts.bodies);
  parts.solveSystems();
  for (const SolvedBody& of : bodies) parts.iterations += of.iterations;
  keepNormalImpulses(projection, parts.bodies, m_residual);
  parts.ties.finish(parts.bodies);
  for (SolvedBody& of : bodies) {
    if (of.solvedAgain) of.dynamics->bendTurns(static_cast<double>(parts.dt()));
    parts.writeVelocities(of);
  }
  parts.hidden.hideLonely(bodies, m_dt);
}

void DeformableSolver::applyTransforms(btScalar dt) {
  Parts& parts = *parts_;
  parts.hidden.show(m_softBodies);
  // A body that has fallen asleep since the step began was not solved for: its velocities are not to be used.
  for (int i = 0; i < m_softBodies.size(); ++i) {
    btSoftBody& body = *m_softBodies[i];
    if (body.isActive() || !parts.solving) continue;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      body.m_nodes[n].m_v.setZero();
      body.m_nodes[n].m_splitv.setZero();
    }
  }
  parts.driven.beforeIntegration(m_softBodies);
  btDeformableBodySolver::applyTransforms(dt);
  parts.driven.end(m_softBodies, dt);
}

}  // namespace tetskin
