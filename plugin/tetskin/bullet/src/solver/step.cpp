// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A step, from top to bottom. Bullet's world calls, in this order:
//   reinitialize                gather          which bodies are awake, and which forces act on them
//   predictMotion               predict         other forces' impulses; the elastic solve, but of bodies that will be
//                                               touched again; where nodes go by it
//   (detection of contacts, by Bullet; its solve of rigid bodies among themselves)
//   solveDeformableConstraints  assemble        contacts, anchors, and what rigid bodies are held by beside, as rows;
//                                               what Bullet's other constraints have changed and fixed
//                               solve           on where nothing was met; else again, with all of that
//                               finishContacts  what contacts have pushed with
//                               writeBack       velocities
//   applyTransforms             positions, by Bullet
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/bullet/src/solver/recorded_forces.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>
#include <tetskin/bullet/src/solver/step.h>
#include <tetskin/bullet/src/solver/system_solve.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

void prepareStep(btSoftBody& body, btScalar dt) {
  body.m_sst.sdt = dt * body.m_cfg.timescale;
  body.m_sst.isdt = 1 / body.m_sst.sdt;
  body.m_sst.velmrg = body.m_sst.sdt * 3;
  body.m_sst.radmrg = body.getCollisionShape()->getMargin();
  body.m_sst.updmrg = body.m_sst.radmrg * btScalar(0.25);
  body.updateBounds();
}

/// Returns the square of the highest speed, before it is bounded.
double moveNodes(btSoftBody& body, btScalar dt) {
  const btScalar fastest = (body.m_bounds[1] - body.m_bounds[0]).length() / dt;
  const btScalar kept = 1 - body.m_cfg.drag;
  double most = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v *= kept;
    // In double: the square of a speed may be out of float's range.
    const double squared = toEigen(node.m_v).squaredNorm();
    const auto allowed = static_cast<double>(fastest);
    if (squared > allowed * allowed) node.m_v *= static_cast<btScalar>(allowed / std::sqrt(squared));
    most = std::max(most, squared);
    node.m_q = node.m_x + dt * node.m_v;
    node.m_splitv.setZero();
    node.m_constrained = false;
  }
  return most;
}

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
  if (auto* own = bodyWithTrees(body)) own->pointContacts().clear();
}

/// Without what a step is too short for: far from the origin, rounded positions keep velocities alive that move
/// nothing.
btVector3 movingPart(const btSoftBody::Node& node, btScalar dt) {
  btVector3 v = node.m_v;
  for (int k = 0; k < 3; ++k) {
    if (node.m_x[k] + dt * v[k] == node.m_x[k]) v[k] = 0;
  }
  return v;
}

/// Several bodies side by side, or one in pieces.
/// task  (SolvedBody&, ParallelFor* inner)
template <class Task>
void forEachBody(std::vector<SolvedBody>& bodies, ParallelFor* threads, Task&& task) {
  ParallelFor* inner = bodies.size() == 1 ? threads : nullptr;
  runTasks(inner ? nullptr : threads, bodies.size(), [&](std::size_t k) { task(bodies[k], inner); });
}

}  // namespace

// ---- gather

/// seconds  0 or less: a body was removed, which is no step
void DeformableSolver::Parts::gather(const btAlignedObjectArray<btSoftBody*>& world, btScalar seconds) {
  solving = solver.solves();
  hidden.show(world);
  all.copyFromArray(world);
  if (seconds > 0 && solving) sleepers.wake(all);
  const bool changed = collect(world);
  if (changed) driven.keepOnly(world);
  if (seconds > 0) driven.begin(solver.m_softBodies, seconds);
  for (int i = 0; i < (changed ? solver.m_numNodes : bodies.awakeCount()); ++i) {
    solver.m_dv[i].setZero();
    solver.m_ddv[i].setZero();
    solver.m_residual[i].setZero();
  }
  if (seconds > 0) {
    solver.m_dt = seconds;
    solver.m_objective->setDt(seconds);
  }
  // They may make a body's dynamics anew.
  for (int i = 0; i < forces().size(); ++i) forces()[i]->reinitialize(changed);
  assign();
}

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

// ---- predict

void DeformableSolver::Parts::predict() {
  useOwnSettings();
  applyOthers();
  for (SolvedBody& of : bodies.bodies()) readNodes(*of.body, false, *of.dynamics);
  for (SolvedSystem& system : bodies.systems()) {
    SolvedBody& first = bodies.bodies()[system.bodies.front()];
    // With other forces, the limits of what these leave are known by what the step begins with.
    first.waits = first.wasTouched && system.forces.empty();
  }
  forEachBody(bodies.bodies(), threads, [&](SolvedBody& of, ParallelFor* inner) { predictVelocities(of, inner); });
  for (SolvedBody& of : bodies.bodies()) {
    writePrediction(of);
    clearContacts(*of.body);
    predictPositions(of);
    if (of.elastic) speculate(of);
  }
}

/// The world tells its own in each step.
void DeformableSolver::Parts::useOwnSettings() {
  solver.setImplicit(false);
  solver.setLineSearch(false);
  solver.m_useProjection = true;
  solver.setStrainLimiting(true);
}

void DeformableSolver::Parts::predictVelocities(SolvedBody& of, ParallelFor* inner) {
  Dynamics& dynamics = *of.dynamics;
  dynamics.predict(static_cast<double>(dt()), inner);
  dynamics.matrix().free();
  if (of.waits) return dynamics.startLater(static_cast<double>(dt()));
  dynamics.start(static_cast<double>(dt()), inner);
  if (of.elastic) solveAlone(of, of.wasTouched ? 0 : of.limits->iterations, inner);
}

void DeformableSolver::Parts::solveAlone(SolvedBody& of, int most, ParallelFor* inner) const {
  const auto seconds = static_cast<double>(dt());
  elastic_detail::SolveLimits limits;
  limits.tolerance = of.limits->tolerance;
  limits.iterations = of.limits->iterations;
  limits.floor = std::max(kUnseen * seconds, of.dynamics->roundingSpeed(seconds));
  limits.enough = limits.tolerance * limits.tolerance * of.dynamics->squaredDeviation();
  of.solve->start({&of.dynamics->matrix()}, limits, {}, inner);
  of.solve->iterate(most, inner);
  of.iterations = of.solve->iterations();
}

void DeformableSolver::Parts::writePrediction(SolvedBody& of) const {
  if (!of.elastic) return;
  const auto& matrix = of.dynamics->matrix();
  for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
    btSoftBody::Node& node = of.body->m_nodes[static_cast<int>(n)];
    if (node.m_im > 0) {
      node.m_v = fromPoint(of.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n));
    }
    btScalar inverse[6];
    matrix.freeInverse(n, inverse);
    node.m_effectiveMass_inv = symmetricMatrix(inverse);
  }
}

/// As btDeformableBodySolver::predictDeformableMotion, but for the trees.
void DeformableSolver::Parts::predictPositions(SolvedBody& of) {
  // Bullet's own also refits the trees of faces.
  if (of.body->m_bUpdateRtCst || meetsByFaces(*of.body)) {
    of.paddedTrees->ready = false;
    solver.predictDeformableMotion(of.body, dt());
    return;
  }
  prepareStep(*of.body, dt());
  const double squaredSpeed = moveNodes(*of.body, dt());
  of.paddedTrees->fit(*of.body, *of.dynamics, static_cast<btScalar>(std::sqrt(squaredSpeed)) * dt());
}

// ---- assemble

void DeformableSolver::Parts::assemble() {
  for (SolvedBody& of : bodies.bodies()) of.dynamics->matrix().free();
  for (SolvedBody& of : bodies.bodies()) readContacts(of);
  addOthers();
  addDynamicFriction(projection(), bodies, solver.m_residual);
  listFixedNodes(projection(), bodies);
  collectRows();
}

/// Bullet's step so far: by how much its constraints have changed the velocities, which begins the solution; and what
/// velocities the whole step begins with.
void DeformableSolver::Parts::readContacts(SolvedBody& of) {
  Dynamics& dynamics = *of.dynamics;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const int number = of.first + static_cast<int>(n);
    const btVector3& before = solver.m_backupVelocity[number];
    btVector3& dv = solver.m_dv[number];
    of.touched |= !dv.isZero();
    if (isNoNumber(dv)) dv.setZero();  // as btDeformableBodySolver::updateVelocity
    btScalar* solution = dynamics.matrix().solution() + dynamics.matrix().wideOf(n);
    // Beside the rigid motion: what the solution has been.
    const btVector3 own = of.elastic ? fromWide(solution) : btVector3(0, 0, 0);
    toPoint(before - own, dynamics.velocity(n));
    toWide(own + dv, solution);
  }
}

// ---- solve

/// What Bullet's forces have a part in is solved here, one after the other, each by all threads; the rest side by side.
void DeformableSolver::Parts::solve() {
  step.resize(solver.m_numNodes, btVector3(0, 0, 0));
  image.resize(solver.m_numNodes, btVector3(0, 0, 0));
  extras.resize(bodies.bodies().size());
  std::vector<SolvedSystem*> own;
  for (SolvedSystem& system : bodies.systems()) {
    system.forces.empty() ? own.push_back(&system) : solveSystem(system, threads);
  }
  ParallelFor* inner = own.size() == 1 ? threads : nullptr;
  runTasks(inner ? nullptr : threads, own.size(), [&](std::size_t k) { solveSystem(*own[k], inner); });
  iterations = passes = unconverged = 0;
  for (const SolvedBody& of : bodies.bodies()) iterations += of.iterations;
  for (const SolvedSystem& system : bodies.systems()) {
    passes += system.passes;
    unconverged += system.converged ? 0 : 1;
  }
}

void DeformableSolver::Parts::solveSystem(SolvedSystem& system, ParallelFor* inner) {
  SolvedBody& first = bodies.bodies()[system.bodies.front()];
  bool again = !system.forces.empty() || !system.rows.empty();
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    again |= !of.fixed.empty() || of.touched;
  }
  if (again) {
    const SolveReport report = SystemSolve(*this, system, inner).solve();
    first.iterations += report.iterations;
    system.passes = report.passes;
    system.converged = report.converged;
    for (const std::size_t b : system.bodies) bodies.bodies()[b].solvedAgain = true;
  } else if (first.elastic) {
    // Of a body that waited for contacts, and has none, all; else on from where it stopped.
    if (first.waits) {
      first.dynamics->startAgain(inner);
      solveAlone(first, first.limits->iterations, inner);
    } else {
      first.solve->iterate(first.limits->iterations, inner);
      first.iterations = first.solve->iterations();
    }
  }
  const bool free = system.forces.empty() && system.rows.empty() && first.fixed.empty() && !first.touched;
  if (free && first.elastic) first.dynamics->removeMomentum();
}

// ---- contacts

void DeformableSolver::Parts::finishContacts() {
  rows.finish(bodies, dt());
  for (RowSource* source : rowSources()) source->finish(dt());
  if (const auto record = recorded.lock()) record->record(bodies, rows.rows(), dt());
}

// ---- write back

void DeformableSolver::Parts::writeBack() {
  for (SolvedBody& of : bodies.bodies()) {
    if (of.solvedAgain) of.dynamics->bendTurns(static_cast<double>(dt()));
    writeVelocities(of);
  }
  hidden.hide(bodies.bodies(), dt());
}

void DeformableSolver::Parts::writeVelocities(SolvedBody& of) const {
  const auto& matrix = of.dynamics->matrix();
  of.body->m_maxSpeedSquared = 0;
  for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
    btSoftBody::Node& node = of.body->m_nodes[static_cast<int>(n)];
    const btVector3 v = fromPoint(of.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n));
    if (node.m_im > 0) node.m_v = v - node.m_splitv;
    of.body->m_maxSpeedSquared = std::max(of.body->m_maxSpeedSquared, movingPart(node, dt()).length2());
  }
}

}  // namespace tetskin
