// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A step, from top to bottom. Bullet's world calls, in this order:
//   reinitialize                gather          which bodies are awake, and which forces act on them
//   predictMotion               predict         other forces' impulses; the elastic solve, except of bodies that will
//                                               be touched again; the positions that follow from it
//   (detection of contacts, by Bullet; its solve of rigid bodies among themselves)
//   solveDeformableConstraints  assemble        rows of contacts, anchors, and other constraints of rigid bodies;
//                                               what Bullet's other constraints have changed and fixed
//                               solve           goes on where nothing was touched; otherwise again, with all of that
//                               finishContacts  reports the impulses of contacts
//                               writeBack       velocities
//   applyTransforms             positions, by Bullet, and then in double: see step_positions.cpp
// The way of a contact: a search (search/, or a RowSource of another library) leaves it in the body's channel
// (base/body_channel.h); `assemble` makes it a row (rows/contact_rows.h); the system linearises and eliminates the row
// (system/system_solve.h); ContactRows::finish writes its impulse, and where it sticks, for the next step; rigid bodies
// get theirs in rows/rigid_rows.h, and records of forces in step/recorded_forces.h.
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/core/src/base/run_by_size.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/destroy_all.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/fixed_nodes.h>
#include <tetskin/solver/src/step/step.h>
#include <tetskin/solver/src/system/system_solve.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// The same as btSoftBody::updateBounds, which reads Bullet's nodes one by one.
void updateBounds(const SolvedBody& solved) {
  btSoftBody& body = *solved.body;
  Dynamics& dynamics = *solved.dynamics;
  assert(dynamics.nodeCount() == static_cast<std::size_t>(body.m_nodes.size()));
  if (dynamics.nodeCount() == 0) return body.updateBounds();
  btVector3 low = fromPoint(dynamics.point(0)), high = low;
  for (std::size_t n = 1; n < dynamics.nodeCount(); ++n) {
    const btVector3 x = fromPoint(dynamics.point(n));
    low.setMin(x);
    high.setMax(x);
  }
  const btScalar margin = body.getCollisionShape()->getMargin();
  const btVector3 around(margin, margin, margin);
  body.m_bounds[0] = low - around;
  body.m_bounds[1] = high + around;
}

void prepareStep(const SolvedBody& solved, btScalar dt) {
  assert(dt > 0);
  btSoftBody& body = *solved.body;
  body.m_sst.sdt = dt * body.m_cfg.timescale;
  body.m_sst.isdt = 1 / body.m_sst.sdt;
  body.m_sst.velmrg = body.m_sst.sdt * 3;
  body.m_sst.radmrg = body.getCollisionShape()->getMargin();
  body.m_sst.updmrg = body.m_sst.radmrg * btScalar(0.25);
  updateBounds(solved);
}

/// Moves the nodes by their velocities, which it bounds first. Returns the square of the highest speed.
double moveNodes(btSoftBody& body, btScalar dt) {
  assert(dt > 0);
  const btScalar fastest = (body.m_bounds[1] - body.m_bounds[0]).length() / dt;
  const btScalar kept = 1 - body.m_cfg.drag;
  double maximum = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v *= kept;
    // In double: the square of a speed may exceed float's range.
    const double squared = toEigen(node.m_v).squaredNorm();
    const auto allowed = static_cast<double>(fastest);
    if (squared > allowed * allowed) node.m_v *= static_cast<btScalar>(allowed / std::sqrt(squared));
    maximum = std::max(maximum, std::min(squared, allowed * allowed));
    node.m_q = node.m_x + dt * node.m_v;
    node.m_splitv.setZero();
    node.m_constrained = false;
  }
  return maximum;
}

btScalar fastestNode(const btSoftBody& body) {
  btScalar squared = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) squared = std::max(squared, body.m_nodes[n].m_v.length2());
  return btSqrt(squared);
}

void setBroadphaseBox(btSoftBody& body) {
  const btSoftBodyWorldInfo& world = *body.getWorldInfo();
  if (!body.getBroadphaseHandle()) return;
  world.m_broadphase->setAabb(body.getBroadphaseHandle(), body.m_bounds[0], body.m_bounds[1], world.m_dispatcher);
}

void resetEffectiveMasses(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (int i = 0; i < bodies.size(); ++i) {
    for (int n = 0; n < bodies[i]->m_nodes.size(); ++n) {
      btSoftBody::Node& node = bodies[i]->m_nodes[n];
      if (node.m_im > 0) node.m_effectiveMass = btMatrix3x3::getIdentity() * (1 / node.m_im);
    }
  }
}

void clearContacts(btSoftBody& body) {
  destroyAll(body.m_nodeRigidContacts);
  destroyAll(body.m_faceRigidContacts);
  destroyAll(body.m_faceNodeContacts);
  destroyAll(body.m_faceNodeContactsCCD);
  if (BodyChannel* channel = channelOf(body)) channel->pointContacts().clear();
}

/// Runs a task for each body: small bodies in parallel; a large one is itself divided among threads.
/// task  (SolvedBody&, ParallelFor* inner)
template <class Task>
void forEachBody(std::vector<SolvedBody>& bodies, ParallelFor* threads, Task&& task) {
  std::vector<std::size_t> sizes;
  sizes.reserve(bodies.size());
  for (const SolvedBody& body : bodies) sizes.push_back(body.dynamics->matrix().slotCount());
  runBySize(
      threads, sizes, [&](std::size_t k) { return elastic_detail::isDivisible(sizes[k]); },
      [&](std::size_t k, ParallelFor* inner) { task(bodies[k], inner); });
}

/// True unless the application has moved the body since the last step, or has changed its velocities, as sleep also
/// does.
bool continuesLastStep(const SolvedBody& solved) {
  if (!solved.dynamics->remembers()) return true;
  for (int n = 0; n < solved.body->m_nodes.size(); ++n) {
    const btSoftBody::Node& node = solved.body->m_nodes[n];
    if (!solved.dynamics->continues(static_cast<std::size_t>(n), node.m_x, node.m_vn)) return false;
  }
  return true;
}

/// The first step of a held body, and steps of varying length, by BodyDynamics::forceShare. Free bodies keep falling
/// beside Bullet's rigid ones.
void staggerHeld(SolvedBody& solved) {
  Dynamics& dynamics = *solved.dynamics;
  solved.start.staggered = solved.elastic && dynamics.isHeld();
  const auto share = static_cast<btScalar>(dynamics.forceShare(solved.start.seconds, solved.start.staggered));
  if (share == 1) return;
  for (int n = 0; n < solved.body->m_nodes.size(); ++n) {
    const btSoftBody::Node& node = solved.body->m_nodes[n];
    toPoint(node.m_vn + share * (node.m_v - node.m_vn), dynamics.velocity(static_cast<std::size_t>(n)));
  }
}

std::size_t nodeCountOf(const SolvedSystem& system, const SolverBodies& bodies) {
  std::size_t count = 0;
  for (const std::size_t b : system.bodies) count += bodies.bodies()[b].dynamics->nodeCount();
  return count;
}

}  // namespace

void DeformableSolver::Impl::enter(Stage next) {
  assert(static_cast<int>(next) == static_cast<int>(stage) + 1);
  stage = next;
}

// ---- gather

void DeformableSolver::Impl::gather(const btAlignedObjectArray<btSoftBody*>& world, btScalar seconds) {
  assert(seconds > 0);
  stage = Stage::Gather;
  solving = solver.ownSolveActive();
  hidden.show(world);
  all.copyFromArray(world);
  forgetRemovedObjects(worldOf(all));
  if (solving) {
    sleepers.wake(all);
    fallAsleep();
  }
  const bool changed = collect(world);
  driven.begin(solver.m_softBodies, seconds);
  for (int i = 0; i < (changed ? solver.m_numNodes : bodies.awakeCount()); ++i) {
    solver.m_dv[i].setZero();
    solver.m_ddv[i].setZero();
    solver.m_residual[i].setZero();
  }
  solver.m_dt = seconds;
  solver.m_objective->setDt(seconds);
  // These calls may recreate a body's dynamics.
  for (int i = 0; i < forces().size(); ++i) forces()[i]->reinitialize(changed);
  assign();
  if (seconds > 0 && solving) rigids.paths().beginStep(bodies.worlds(), seconds);
}

void DeformableSolver::Impl::fallAsleep() {
  const auto waited = [](const btSoftBody* body) { return body->getActivationState() == WANTS_DEACTIVATION; };
  for (int i = 0; i < all.size(); ++i) {
    if (!waited(all[i])) continue;
    for (btSoftBody* body : stillness.fallAsleep(SolverBodies::worldsOf(forces()))) sleepers.store(*body);
    return;
  }
}

bool DeformableSolver::Impl::collect(const btAlignedObjectArray<btSoftBody*>& world) {
  const bool changed = bodies.collect(world, !solving, solver.m_softBodies);
  if (changed) numberAnew();
  solver.m_objective->m_projection.reinitialize(changed);
  return changed;
}

void DeformableSolver::Impl::assign() {
  if (solving) return bodies.assign(forces());
  bodies.clear();
  resetEffectiveMasses(solver.m_softBodies);
}

// ---- predict

void DeformableSolver::Impl::predict() {
  enter(Stage::Predict);
  useOwnSettings();
  applyOthers();
  forEachBody(bodies.bodies(), threads, [&](SolvedBody& body, ParallelFor*) {
    body.start.seconds = static_cast<double>(dt());
    body.start.continues = continuesLastStep(body);
    body.start.pressed = body.before.any;
    body.start.touched = body.before.contacts;
    body.start.impact = impacts.includes(*body.body);
    readNodes(*body.body, *body.dynamics);
    body.dynamics->setDeterministic(deterministic);
    staggerHeld(body);
  });
  impacts.giveBack(bodies, rigids);
  for (SolvedBody& body : bodies.bodies()) prepareSearch(body);
  for (SolvedSystem& system : bodies.systems()) {
    SolvedBody& first = bodies.bodies()[system.bodies.front()];
    // With other forces, the velocities at the beginning of the step determine the tolerances.
    first.solve.deferred = first.before.any && system.forces.empty();
  }
  forEachBody(bodies.bodies(), threads, [&](SolvedBody& body, ParallelFor* inner) {
    predictVelocities(body, inner);
    writePrediction(body);
    if (!body.byBullet) predictPositions(body);
  });
  for (SolvedBody& body : bodies.bodies()) {
    clearContacts(*body.body);
    body.byBullet ? predictByBullet(body) : setBroadphaseBox(*body.body);
  }
}

/// The world sets its own values in each step.
void DeformableSolver::Impl::useOwnSettings() {
  solver.setImplicit(false);
  solver.setLineSearch(false);
  solver.m_useProjection = true;
  solver.setStrainLimiting(true);
}

void DeformableSolver::Impl::predictVelocities(SolvedBody& body, ParallelFor* inner) {
  assert(body.start.seconds == static_cast<double>(dt()));
  Dynamics& dynamics = *body.dynamics;
  dynamics.predict(body.start, inner);
  body.solve.unseenSpeed = unseenSpeed(body);
  if (body.solve.deferred) return;
  dynamics.findResidual(inner);
  if (body.elastic) solveAlone(body, body.before.any ? 0 : body.settings->iterations, inner);
}

void DeformableSolver::Impl::solveAlone(SolvedBody& body, int maximum, ParallelFor* inner) const {
  assert(body.elastic && maximum >= 0);
  elastic_detail::SolveLimits limits;
  limits.tolerance = body.settings->tolerance;
  limits.iterations = body.settings->iterations;
  limits.enough = body.dynamics->squaredImpulses(body.solve.unseenSpeed);
  body.solve.iterations = body.dynamics->solve(body.memory->gradient, limits, maximum, inner);
}

void DeformableSolver::Impl::writePrediction(SolvedBody& body) const {
  if (!body.elastic) return;
  const auto& matrix = body.dynamics->matrix();
  assert(body.dynamics->nodeCount() == static_cast<std::size_t>(body.body->m_nodes.size()));
  for (std::size_t n = 0; n < body.dynamics->nodeCount(); ++n) {
    btSoftBody::Node& node = body.body->m_nodes[static_cast<int>(n)];
    if (node.m_im > 0) {
      node.m_v = fromPoint(body.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n));
    }
    btScalar inverse[6];
    matrix.freeInverse(n, inverse);
    node.m_effectiveMass_inv = symmetricMatrix(inverse);
  }
}

/// Uses Bullet's own function, which also refits the trees of nodes and faces.
void DeformableSolver::Impl::predictByBullet(SolvedBody& body) {
  assert(body.byBullet);
  body.memory->paddedTrees.forget();
  solver.predictDeformableMotion(body.body, dt());
  if (body.elastic) speculate(body, fastestNode(*body.body));
}

/// The same as btDeformableBodySolver::predictDeformableMotion, except for the trees and the box in the broadphase.
void DeformableSolver::Impl::predictPositions(SolvedBody& body) {
  assert(!body.byBullet);
  prepareStep(body, dt());
  const double squared = moveNodes(*body.body, dt());
  const auto fastest = static_cast<btScalar>(std::sqrt(squared));
  body.memory->paddedTrees.fit(*body.body, *body.dynamics, fastest * dt());
  if (body.elastic) speculate(body, fastest);
}

// ---- assemble

void DeformableSolver::Impl::assemble() {
  enter(Stage::Assemble);
  assert(solver.m_dv.size() >= bodies.awakeCount() && solver.m_backupVelocity.size() >= bodies.awakeCount());
  forEachBody(bodies.bodies(), threads, [&](SolvedBody& body, ParallelFor*) {
    body.dynamics->matrix().free();
    readContacts(body);
  });
  dropRemovedForces();
  addOthers();
  addDynamicFriction(projection(), bodies, solver.m_residual);
  listFixedNodes(projection(), bodies);
  collectRows();
  impacts.begin(rows, bodies, rigids, dt());
  std::vector<char> touched(bodies.bodies().size(), 0);
  for (const ContactRow& row : rows.rows()) {
    if (row.joined) continue;
    for (const RowEnd& end : row.ends) {
      if (!end.isSoft()) continue;
      assert(end.body < touched.size());
      touched[end.body] = 1;
    }
  }
  forEachBody(bodies.bodies(), threads, [&](SolvedBody& body, ParallelFor* inner) {
    const auto index = static_cast<std::size_t>(&body - bodies.bodies().data());
    if (touched[index]) body.dynamics->beTouched(impacts.includes(*body.body), inner);
  });
}

/// Reads the result of Bullet's step so far: the change of velocity by its constraints, from which the solution starts,
/// and the velocities at the beginning of the whole step.
void DeformableSolver::Impl::readContacts(SolvedBody& body) {
  assert(body.first + static_cast<int>(body.dynamics->nodeCount()) <= solver.m_dv.size());
  Dynamics& dynamics = *body.dynamics;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const int number = body.first + static_cast<int>(n);
    const btVector3& before = solver.m_backupVelocity[number];
    btVector3& dv = solver.m_dv[number];
    body.acted.changed |= !dv.isZero();
    if (isNaN(dv)) dv.setZero();  // the same test as in btDeformableBodySolver::updateVelocity
    btScalar* solution = dynamics.matrix().solution() + dynamics.matrix().wideOf(n);
    // The solution relative to the rigid motion.
    const btVector3 own = body.elastic ? fromWide(solution) : btVector3(0, 0, 0);
    toPoint(before - own, dynamics.velocity(n));
    toWide(own + dv, solution);
  }
}

// ---- solve

/// Systems with Bullet's forces are solved here one after the other, each by all threads; of the others, small ones in
/// parallel.
void DeformableSolver::Impl::solve() {
  enter(Stage::Solve);
  others.beginStep(bodies, solver.m_residual, solver.m_backupVelocity, dt());
  std::vector<SolvedSystem*> own;
  std::vector<std::size_t> sizes;
  for (SolvedSystem& system : bodies.systems()) {
    if (!system.forces.empty()) {
      solveSystem(system, threads);
      continue;
    }
    own.push_back(&system);
    sizes.push_back(nodeCountOf(system, bodies));
  }
  const auto isDivided = [&](std::size_t k) {
    return own[k]->bodies.size() > 1 || elastic_detail::isDivisible(sizes[k]);
  };
  runBySize(threads, sizes, isDivided, [&](std::size_t k, ParallelFor* inner) { solveSystem(*own[k], inner); });
  iterations = passes = unconverged = 0;
  for (const SolvedBody& body : bodies.bodies()) iterations += body.solve.iterations;
  for (const SolvedSystem& system : bodies.systems()) {
    passes += system.passes;
    unconverged += system.converged ? 0 : 1;
  }
}

void DeformableSolver::Impl::solveSystem(SolvedSystem& system, ParallelFor* inner) {
  assert(stage == Stage::Solve && !system.bodies.empty());
  // Several bodies without a force are those of one that has left within the step.
  bool alone = system.bodies.size() == 1 && system.forces.empty() && system.rows.empty();
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = bodies.bodies()[b];
    alone &= body.acted.fixed.empty() && !body.acted.changed;
  }
  alone ? finishAlone(system, inner) : solveAgain(system, inner);
}

void DeformableSolver::Impl::solveAgain(SolvedSystem& system, ParallelFor* inner) {
  const SolveReport report = SystemSolve({bodies, rows, rigids, others}, system, inner).solve();
  bodies.bodies()[system.bodies.front()].solve.iterations += report.iterations;
  system.passes = report.passes;
  system.converged = report.converged;
  for (const std::size_t b : system.bodies) {
    SolvedBody& body = bodies.bodies()[b];
    body.solve.again = true;
    if (body.elastic) body.dynamics->remember(elastic_detail::SolvedWith::Others, inner);
  }
}

/// A body whose solve was deferred because of possible contacts, but which has none, is solved with all iterations; any
/// other continues where it stopped.
void DeformableSolver::Impl::finishAlone(SolvedSystem& system, ParallelFor* inner) {
  SolvedBody& body = bodies.bodies()[system.bodies.front()];
  if (!body.elastic) return;
  auto& gradient = body.memory->gradient;
  if (body.solve.deferred) {
    body.dynamics->findResidual(inner);
    solveAlone(body, body.settings->iterations, inner);
  } else {
    const int before = gradient.iterations();
    gradient.iterate(body.settings->iterations, inner);
    body.solve.iterations += gradient.iterations() - before;
  }
  system.converged = gradient.squaredResidual() <= gradient.enough();
  body.dynamics->remember(elastic_detail::SolvedWith::ElasticityAlone, inner);
  body.dynamics->removeMomentum();
}

// ---- contacts

void DeformableSolver::Impl::finishContacts() {
  assert(stage == Stage::Solve);
  rows.finish(bodies, dt());
  impacts.finish(rows, bodies, rigids, dt());
  for (RowSource* source : rowSources()) source->finish(dt());
  if (const auto record = recorded.lock()) record->record(bodies, rows, impacts.given(), dt());
}

// ---- write back

void DeformableSolver::Impl::writeBack() {
  enter(Stage::WriteBack);
  forEachBody(bodies.bodies(), threads, [&](SolvedBody& body, ParallelFor* inner) {
    if (body.solve.again) body.dynamics->bendTurns();
    if (body.elastic)
      body.dynamics->shortenStep(
          body.solve.again ? elastic_detail::SolvedWith::Others : elastic_detail::SolvedWith::ElasticityAlone, inner);
    writeVelocities(body);
    listForeignNodes(body);
  });
  findShaken();
  stillness.judge(bodies, rigids, dt());
  hidden.hide(bodies.bodies(), dt());
}

void DeformableSolver::Impl::writeVelocities(SolvedBody& body) const {
  const auto& matrix = body.dynamics->matrix();
  const bool rounded = !body.elastic || body.memory->rows.contacts;
  assert(body.dynamics->nodeCount() <= static_cast<std::size_t>(body.body->m_nodes.size()));
  body.body->m_maxSpeedSquared = 0;
  for (std::size_t n = 0; n < body.dynamics->nodeCount(); ++n) {
    btSoftBody::Node& node = body.body->m_nodes[static_cast<int>(n)];
    const btVector3 v = fromPoint(body.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n));
    if (node.m_im > 0) node.m_v = v - node.m_splitv;
    const btVector3 seen = rounded ? movingComponent(node.m_x, node.m_v, dt()) : node.m_v;
    body.body->m_maxSpeedSquared = std::max(body.body->m_maxSpeedSquared, seen.length2());
  }
}

}  // namespace tetskin
