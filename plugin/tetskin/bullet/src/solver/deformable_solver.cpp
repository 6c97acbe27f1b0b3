// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A step. Bullet's world calls, in this order:
//   reinitialize                which bodies are awake
//   predictMotion               other forces' impulses; the elastic solve, short if contacts are to be expected
//   (detection and solve of contacts, by Bullet, with the inverse diagonal blocks for masses of nodes)
//   solveDeformableConstraints  goes on where nothing was met; else solves again, with what contacts have fixed
//   applyTransforms             positions
#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

using kernels::kGroup;
using Solve = elastic_detail::ConjugateGradient<btScalar>;

/// Iterations before contacts are looked for, where there were some in the step before: what they find is refined after
/// them.
constexpr int kIterationsBeforeContacts = 3;
/// An error in velocity that nobody sees, over what the earth's gravity gives in a step.
constexpr double kUnseen = 1e-3 * 9.81;

/// Of the leaves of a body's trees, in collision margins: more is to be looked at for contacts, less often to be
/// fitted.
constexpr btScalar kPadding = 2;

/// Whether Bullet looks for what a body meets among soft ones, itself included, whatever there is.
bool meetsSoftBodies(btSoftBody& body) {
  return (body.m_cfg.collisions & btSoftBody::fCollision::SVSmask) != 0 || body.useSelfCollision();
}

void resetEffectiveMasses(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (int i = 0; i < bodies.size(); ++i) {
    for (int n = 0; n < bodies[i]->m_nodes.size(); ++n) {
      btSoftBody::Node& node = bodies[i]->m_nodes[n];
      if (node.m_im > 0) node.m_effectiveMass = btMatrix3x3::getIdentity() * (1 / node.m_im);
    }
  }
}

/// Whether contacts are looked for on a body's faces, which must then be where they are predicted.
bool meetsByFaces(btSoftBody& body) {
  constexpr int kFaces = btSoftBody::fCollision::SDF_RDF | btSoftBody::fCollision::SDF_MDF;
  return (body.m_cfg.collisions & kFaces) != 0 || meetsSoftBodies(body);
}

}  // namespace

struct DeformableSolver::Parts {
  explicit Parts(DeformableSolver& ofSolver) : solver(ofSolver) {}

  ForceList& forces() { return solver.m_objective->m_lf; }
  bool implicit() const { return solver.m_implicit; }
  btScalar dt() const { return solver.m_dt; }

  bool collect(const btAlignedObjectArray<btSoftBody*>& all);
  void applyOthers();
  void applyOthersImplicitly();
  void predict(SolvedBody& of, ParallelFor* inner);
  void writePrediction(SolvedBody& of) const;
  void predictPositions(SolvedBody& of) const;
  void forEachBody(void (Parts::*task)(SolvedBody&, ParallelFor*));
  void addOthers();
  void readContacts(SolvedBody& of);
  void solve(const SolvedSystem& system, ParallelFor* inner);
  void solveAgain(const SolvedSystem& system, ParallelFor* inner);
  void addExtra(const SolvedSystem& system, std::vector<const btScalar*>& added);
  void writeVelocities(SolvedBody& of) const;
  void hideLonely();
  void unhide(const btAlignedObjectArray<btSoftBody*>& alive);

  DeformableSolver& solver;
  SolverBodies bodies;
  ParallelFor* threads = nullptr;
  bool nodeNormals = true;
  bool solving = true;  ///< in this step
  int iterations = 0;
  btAlignedObjectArray<btSoftBody*> all;
  VectorStack step, image;                          ///< of systems with other forces
  std::vector<std::vector<btScalar>> extras;        ///< by body, wide
  std::vector<std::pair<btSoftBody*, int>> marked;  ///< as sleeping, and the state before
};

DeformableSolver::DeformableSolver() : parts_(std::make_unique<Parts>(*this)) {
  m_useProjection = true;
  m_implicit = false;
  m_dt = 0;
}
DeformableSolver::~DeformableSolver() = default;

void DeformableSolver::setThreads(ParallelFor* threads) {
  parts_->threads = threads;
}
void DeformableSolver::setNodeNormals(bool on) {
  parts_->nodeNormals = on;
}
bool DeformableSolver::solves() const {
  return m_useProjection && !m_lineSearch;
}
int DeformableSolver::iterations() const {
  return parts_->iterations;
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

void DeformableSolver::reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) {
  Parts& parts = *parts_;
  parts.solving = solves();
  parts.unhide(softBodies);
  parts.all.copyFromArray(softBodies);
  const bool changed = parts.collect(softBodies);
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
  if (parts.solving) {
    parts.bodies.assign(parts.forces());
  } else {
    parts.bodies.release(parts.forces());
  }
  if (!parts.solving || m_implicit) resetEffectiveMasses(m_softBodies);
  updateSoftBodies();
}

void DeformableSolver::updateSoftBodies() {
  if (parts_->nodeNormals) btDeformableBodySolver::updateSoftBodies();
}

/// As btDeformableBackwardEulerObjective::applyExplicitForce, where elastic forces are explicit.
void DeformableSolver::Parts::applyOthers() {
  VectorStack& impulses = solver.m_residual;
  for (int i = 0; i < forces().size(); ++i) forces()[i]->addScaledExplicitForce(dt(), impulses);
  for (SolvedBody& of : bodies.bodies()) {
    for (int n = 0; n < of.body->m_nodes.size(); ++n) {
      btSoftBody::Node& node = of.body->m_nodes[n];
      node.m_v += node.m_im * impulses[of.first + n];
      impulses[of.first + n].setZero();
    }
  }
}

/// The same where they are implicit: gravity is the last force's of that type, for all bodies.
void DeformableSolver::Parts::applyOthersImplicitly() {
  VectorStack& impulses = solver.m_residual;
  for (SolvedBody& of : bodies.bodies()) {
    for (int n = 0; n < of.body->m_nodes.size(); ++n) {
      btSoftBody::Node& node = of.body->m_nodes[n];
      node.m_q = node.m_x + dt() * node.m_v;
    }
    if (of.needsDeformation) of.body->advanceDeformation();
  }
  btVector3 gravity(0, 0, 0);
  for (int i = 0; i < forces().size(); ++i) {
    if (forces()[i]->getForceType() == BT_GRAVITY_FORCE) {
      gravity = static_cast<btDeformableGravityForce*>(forces()[i])->m_gravity;
    } else {
      forces()[i]->addScaledForces(dt(), impulses);
    }
  }
  for (int i = 0; i < forces().size(); ++i) forces()[i]->addScaledHessian(dt());
  for (SolvedBody& of : bodies.bodies()) {
    for (int n = 0; n < of.body->m_nodes.size(); ++n) {
      btSoftBody::Node& node = of.body->m_nodes[n];
      node.m_effectiveMass_inv =
          node.m_im > 0 ? node.m_effectiveMass.inverse() : btMatrix3x3::getIdentity() * btScalar(0);
      node.m_v += node.m_effectiveMass_inv * impulses[of.first + n] + dt() * of.body->m_gravityFactor * gravity;
      impulses[of.first + n].setZero();
    }
  }
}

/// The elastic solve before contacts.
void DeformableSolver::Parts::predict(SolvedBody& of, ParallelFor* inner) {
  Dynamics& dynamics = *of.dynamics;
  if (implicit() && of.elastic) {
    // From where the step began: other forces, gravity too, act again in its one solve.
    for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
      const btVector3& v = of.body->m_nodes[static_cast<int>(n)].m_vn;
      for (int k = 0; k < 3; ++k) dynamics.velocity(n)[k] = v[k];
    }
  }
  dynamics.prepare(static_cast<double>(dt()), inner);
  dynamics.matrix().free();
  dynamics.start(static_cast<double>(dt()), inner);
  if (!of.elastic) return;
  const bool touched =
      std::any_of(of.normalImpulses->begin(), of.normalImpulses->end(), [](btScalar impulse) { return impulse != 0; });
  elastic_detail::SolveLimits limits;
  limits.tolerance = of.limits->tolerance;
  limits.iterations = of.limits->iterations;
  limits.floor = kUnseen * static_cast<double>(dt());
  of.solve->start({&dynamics.matrix()}, limits, {}, inner);
  of.solve->iterate(touched ? kIterationsBeforeContacts : limits.iterations, inner);
}

void DeformableSolver::Parts::writePrediction(SolvedBody& of) const {
  if (!of.elastic) return;
  const auto& matrix = of.dynamics->matrix();
  for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
    btSoftBody::Node& node = of.body->m_nodes[static_cast<int>(n)];
    const btScalar* dv = matrix.solution() + matrix.wideOf(n);
    node.m_v += btVector3(dv[0], dv[kGroup], dv[2 * kGroup]);
    btScalar d[6];
    matrix.freeInverse(n, d);
    node.m_effectiveMass_inv.setValue(d[0], d[1], d[2], d[1], d[3], d[4], d[2], d[4], d[5]);
  }
}

/// Several bodies side by side, or one in pieces.
void DeformableSolver::Parts::forEachBody(void (Parts::*task)(SolvedBody&, ParallelFor*)) {
  auto& list = bodies.bodies();
  ParallelFor* inner = list.size() == 1 ? threads : nullptr;
  runTasks(inner ? nullptr : threads, list.size(), [&](std::size_t k) { (this->*task)(list[k], inner); });
}

void DeformableSolver::predictMotion(btScalar dt) {
  Parts& parts = *parts_;
  if (parts.solving != solves()) {
    // The world's settings have changed since the step before.
    parts.solving = solves();
    parts.collect(parts.all);
    if (!parts.solving) resetEffectiveMasses(m_softBodies);
    parts.solving ? parts.bodies.assign(parts.forces()) : parts.bodies.release(parts.forces());
  }
  if (!parts.solving) return btDeformableBodySolver::predictMotion(dt);

  if (m_implicit) {
    parts.applyOthersImplicitly();
  } else {
    for (SolvedBody& of : parts.bodies.bodies()) {
      if (of.needsDeformation) of.body->advanceDeformation();
    }
    parts.applyOthers();
    for (SolvedBody& of : parts.bodies.bodies()) {
      if (of.elastic) continue;
      for (int n = 0; n < of.body->m_nodes.size(); ++n) {
        btSoftBody::Node& node = of.body->m_nodes[n];
        node.m_effectiveMass_inv = btMatrix3x3::getIdentity() * node.m_im;
      }
    }
  }
  for (SolvedBody& of : parts.bodies.bodies()) readNodes(*of.body, false, *of.dynamics);
  parts.forEachBody(&Parts::predict);
  for (SolvedBody& of : parts.bodies.bodies()) {
    parts.writePrediction(of);
    btSoftBody& body = *of.body;
    body.m_nodeRigidContacts.resize(0);
    body.m_faceRigidContacts.resize(0);
    body.m_faceNodeContacts.resize(0);
    body.m_faceNodeContactsCCD.resize(0);
    // Bullet's own also refits the trees of faces.
    if (m_implicit || body.m_bUpdateRtCst || meetsByFaces(body)) {
      of.fittedTrees->ready = false;
      predictDeformableMotion(&body, dt);
    } else {
      parts.predictPositions(of);
    }
  }
}

/// As btDeformableBodySolver::predictDeformableMotion, but for the trees. Their leaves are padded; as long as nodes
/// stay in them, contacts and rays find all there is, and they need not be fitted again.
void DeformableSolver::Parts::predictPositions(SolvedBody& of) const {
  btSoftBody& body = *of.body;
  const btScalar margin = body.getCollisionShape()->getMargin();
  body.m_sst.sdt = dt() * body.m_cfg.timescale;
  body.m_sst.isdt = 1 / body.m_sst.sdt;
  body.m_sst.velmrg = body.m_sst.sdt * 3;
  body.m_sst.radmrg = margin;
  body.m_sst.updmrg = margin * btScalar(0.25);
  body.updateBounds();
  const btScalar fastest = (body.m_bounds[1] - body.m_bounds[0]).length() / dt();
  const btScalar kept = 1 - body.m_cfg.drag;
  btScalar most = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v *= kept;
    const btScalar squared = node.m_v.length2();
    if (squared > fastest * fastest) node.m_v *= fastest / btSqrt(squared);
    most = std::max(most, squared);
    node.m_q = node.m_x + dt() * node.m_v;
    node.m_splitv.setZero();
    node.m_constrained = false;
  }
  FittedTrees& fitted = *of.fittedTrees;
  if (fitted.pad != kPadding * margin) fitted.ready = false;
  fitted.pad = kPadding * margin;
  fitted.drift = fitted.ready ? fitted.furthest(*of.dynamics) : fitted.pad;
  if (fitted.holds(btSqrt(most) * dt())) return;
  body.m_sst.radmrg = fitted.pad;
  body.updateNodeTree(true, true);
  if (!body.m_fdbvt.empty()) body.updateFaceTree(true, true);
  body.m_sst.radmrg = margin;
  fitted.keep(*of.dynamics);
}

/// As btDeformableBackwardEulerObjective::computeResidual.
void DeformableSolver::Parts::addOthers() {
  for (int i = 0; i < forces().size(); ++i) {
    btDeformableLagrangianForce& force = *forces()[i];
    if (implicit() || force.getForceType() == BT_MOUSE_PICKING_FORCE) {
      force.addScaledForces(dt(), solver.m_residual);
    } else {
      force.addScaledDampingForce(dt(), solver.m_residual);
    }
  }
}

/// Bullet's step so far: by how much contacts have changed the velocities, which begins the solution; and what
/// velocities the whole step begins with.
void DeformableSolver::Parts::readContacts(SolvedBody& of) {
  Dynamics& dynamics = *of.dynamics;
  btScalar* solution = dynamics.matrix().solution();
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const int number = of.first + static_cast<int>(n);
    const btSoftBody::Node& node = of.body->m_nodes[static_cast<int>(n)];
    const btVector3& dv = solver.m_dv[number];
    btScalar* x = &solution[dynamics.matrix().wideOf(n)];
    for (int k = 0; k < 3; ++k) {
      btScalar& own = x[k * kGroup];
      if (implicit()) own = 0;
      dynamics.velocity(n)[k] = solver.m_backupVelocity[number][k] - own;
      own += dv[k];
    }
    of.touched |= !dv.isZero();
    if (implicit()) {
      btSoftBody::Node& moved = of.body->m_nodes[static_cast<int>(n)];
      moved.m_v = solver.m_backupVelocity[number] + dv;
      moved.m_q = node.m_x + dt() * (node.m_v + node.m_splitv);
    }
  }
  if (implicit() && of.needsDeformation) of.body->updateDeformation();
}

/// What others add to the matrices times their `stepPoints`, or, with `added` empty, to what contacts have done.
void DeformableSolver::Parts::addExtra(const SolvedSystem& system, std::vector<const btScalar*>& added) {
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
      const int number = of.first + static_cast<int>(n);
      const btScalar* t = of.dynamics->matrix().stepPoints() + 4 * of.dynamics->matrix().slotOf(n);
      step[number] = added.empty() ? solver.m_dv[number] : btVector3(t[0], t[1], t[2]);
      image[number].setZero();
    }
  }
  for (btDeformableLagrangianForce* force : system.forces) {
    force->addScaledDampingForceDifferential(-dt(), step, image);
    if (implicit() || force->getForceType() == BT_MOUSE_PICKING_FORCE) {
      force->addScaledElasticForceDifferential(-dt() * dt(), step, image);
    }
  }
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const SolvedBody& of = bodies.bodies()[system.bodies[k]];
    std::vector<btScalar>& extra = extras[system.bodies[k]];
    extra.resize(of.dynamics->matrix().wideSize(), btScalar(0));
    for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
      const btVector3& v = image[of.first + static_cast<int>(n)];
      btScalar* to = &extra[of.dynamics->matrix().wideOf(n)];
      for (int c = 0; c < 3; ++c) to[c * kGroup] = v[c];
    }
    if (!added.empty()) added[k] = extra.data();
  }
}

void DeformableSolver::Parts::solve(const SolvedSystem& system, ParallelFor* inner) {
  SolvedBody& first = bodies.bodies()[system.bodies.front()];
  bool again = implicit() || !system.forces.empty();
  for (const std::size_t b : system.bodies) again |= bodies.bodies()[b].constrained || bodies.bodies()[b].touched;
  if (again) return solveAgain(system, inner);
  if (!first.elastic) return;
  first.solve->iterate(first.limits->iterations, inner);
  first.dynamics->removeMomentum();
}

void DeformableSolver::Parts::solveAgain(const SolvedSystem& system, ParallelFor* inner) {
  elastic_detail::SolveLimits limits;
  limits.floor = kUnseen * static_cast<double>(dt());
  limits.iterations = 0;
  std::vector<elastic_detail::BlockMatrix<btScalar>*> matrices;
  const bool coupled = !system.forces.empty();
  if (coupled && !implicit()) {
    std::vector<const btScalar*> none;
    addExtra(system, none);
  }
  for (const std::size_t b : system.bodies) {
    SolvedBody& of = bodies.bodies()[b];
    matrices.push_back(&of.dynamics->matrix());
    limits.tolerance = std::min(limits.tolerance, of.limits->tolerance);
    limits.iterations = std::max(limits.iterations, of.limits->iterations);
    if (of.elastic) limits.enough += of.solve->enough();
    of.dynamics->startAgain(inner);
    btScalar* residual = of.dynamics->matrix().residual();
    for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
      const std::size_t wide = of.dynamics->matrix().wideOf(n);
      const btVector3& impulse = solver.m_residual[of.first + static_cast<int>(n)];
      for (int k = 0; k < 3; ++k) {
        btScalar& r = residual[wide + static_cast<std::size_t>(k * kGroup)];
        r += impulse[k];
        if (coupled && !implicit()) r -= extras[b][wide + static_cast<std::size_t>(k * kGroup)];
      }
    }
  }
  Solve::Extra extra;
  if (coupled) extra = [&](std::vector<const btScalar*>& added) { addExtra(system, added); };
  Solve& solve = *bodies.bodies()[system.bodies.front()].solve;
  const int before = solve.iterations();
  solve.start(std::move(matrices), limits, std::move(extra), inner);
  solve.iterate(limits.iterations, inner);
  solve.addIterations(before);
}

void DeformableSolver::Parts::writeVelocities(SolvedBody& of) const {
  btSoftBody& body = *of.body;
  const auto& matrix = of.dynamics->matrix();
  body.m_maxSpeedSquared = 0;
  for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
    btSoftBody::Node& node = body.m_nodes[static_cast<int>(n)];
    const btScalar* dv = matrix.solution() + matrix.wideOf(n);
    const btScalar* before = of.dynamics->velocity(n);
    const btVector3 v(before[0] + dv[0], before[1] + dv[kGroup], before[2] + dv[2 * kGroup]);
    node.m_v = implicit() ? v : v - node.m_splitv;
    body.m_maxSpeedSquared = std::max(body.m_maxSpeedSquared, node.m_v.length2());
  }
}

/// Bullet looks between the solve and the integration for what soft bodies meet among each other, and refits their
/// trees for it. Where nothing can be met it need not: it passes over bodies that sleep.
void DeformableSolver::Parts::hideLonely() {
  struct Entry {
    const SolvedBody* of;
    btVector3 low, high;
    bool met;
  };
  std::vector<Entry> entries;
  for (const SolvedBody& of : bodies.bodies()) {
    const btDbvtNode* root = of.body->m_ndbvt.m_root;
    // What is not a number has no place among the others.
    if (root && std::isfinite(root->volume.Mins().x()))
      entries.push_back({&of, root->volume.Mins(), root->volume.Maxs(), false});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.low.x() < b.low.x(); });
  for (std::size_t a = 0; a < entries.size(); ++a) {
    for (std::size_t b = a + 1; b < entries.size() && entries[b].low.x() <= entries[a].high.x(); ++b) {
      const bool apart = entries[b].low.y() > entries[a].high.y() || entries[b].high.y() < entries[a].low.y() ||
                         entries[b].low.z() > entries[a].high.z() || entries[b].high.z() < entries[a].low.z();
      if (!apart) entries[a].met = entries[b].met = true;
    }
  }
  for (const Entry& entry : entries) {
    btSoftBody& body = *entry.of->body;
    FittedTrees& fitted = *entry.of->fittedTrees;
    const bool held = fitted.holds(btSqrt(body.m_maxSpeedSquared) * dt());
    if (entry.met || !held || !body.isActive() || meetsSoftBodies(body)) {
      fitted.ready = false;  // Bullet fits them tightly
      continue;
    }
    marked.emplace_back(&body, body.getActivationState());
    body.forceActivationState(ISLAND_SLEEPING);
  }
}

/// Unless somebody has woken a body, or put it to sleep, or taken it out of the world.
void DeformableSolver::Parts::unhide(const btAlignedObjectArray<btSoftBody*>& alive) {
  for (const auto& [body, state] : marked) {
    if (alive.findLinearSearch(body) == alive.size()) continue;
    if (body->getActivationState() == ISLAND_SLEEPING) body->forceActivationState(state);
  }
  marked.clear();
}

void DeformableSolver::solveDeformableConstraints(btScalar dt) {
  Parts& parts = *parts_;
  if (!parts.solving) return btDeformableBodySolver::solveDeformableConstraints(dt);

  auto& bodies = parts.bodies.bodies();
  const btDeformableContactProjection& projection = m_objective->m_projection;
  for (SolvedBody& of : bodies) of.dynamics->matrix().free();
  for (SolvedBody& of : bodies) parts.readContacts(of);
  parts.addOthers();
  addDynamicFriction(projection, parts.bodies, m_residual);
  fixContacts(projection, parts.bodies);

  // What Bullet's forces have a part in is solved here, one after the other; the rest side by side.
  parts.step.resize(m_numNodes, btVector3(0, 0, 0));
  parts.image.resize(m_numNodes, btVector3(0, 0, 0));
  parts.extras.resize(bodies.size());
  std::vector<const SolvedSystem*> own;
  for (const SolvedSystem& system : parts.bodies.systems()) {
    if (system.forces.empty())
      own.push_back(&system);
    else
      parts.solve(system, nullptr);
  }
  ParallelFor* inner = own.size() == 1 ? parts.threads : nullptr;
  runTasks(inner ? nullptr : parts.threads, own.size(), [&](std::size_t k) { parts.solve(*own[k], inner); });

  parts.iterations = 0;
  for (SolvedBody& of : bodies) parts.iterations += of.solve->iterations();
  keepNormalImpulses(projection, parts.bodies, m_residual);
  for (SolvedBody& of : bodies) parts.writeVelocities(of);
  parts.hideLonely();
}

void DeformableSolver::applyTransforms(btScalar dt) {
  Parts& parts = *parts_;
  parts.unhide(m_softBodies);
  // A body that has fallen asleep since the step began was not solved for: its velocities are not to be used.
  for (int i = 0; i < m_softBodies.size(); ++i) {
    btSoftBody& body = *m_softBodies[i];
    if (body.isActive() || !parts.solving) continue;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      body.m_nodes[n].m_v.setZero();
      body.m_nodes[n].m_splitv.setZero();
    }
  }
  btDeformableBodySolver::applyTransforms(dt);
}

}  // namespace tetskin
