// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A step up to where contacts are looked for: other forces' impulses, the elastic solve, and where nodes go by them.
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/solver_parts.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

/// Iterations before contacts are looked for, where there were some in the step before: what they find is refined after
/// them.
constexpr int kIterationsBeforeContacts = 3;

bool wasTouched(const SolvedBody& of) {
  return std::any_of(of.normalImpulses->begin(), of.normalImpulses->end(),
                     [](btScalar impulse) { return impulse != 0; });
}

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

}  // namespace

/// As btDeformableBackwardEulerObjective::applyExplicitForce, where elastic forces are explicit.
void DeformableSolver::Parts::applyOthers() {
  for (SolvedBody& of : bodies.bodies()) {
    if (of.needsDeformation) of.body->advanceDeformation();
  }
  VectorStack& impulses = solver.m_residual;
  for (int i = 0; i < forces().size(); ++i) forces()[i]->addScaledExplicitForce(dt(), impulses);
  for (SolvedBody& of : bodies.bodies()) {
    for (int n = 0; n < of.body->m_nodes.size(); ++n) {
      btSoftBody::Node& node = of.body->m_nodes[n];
      node.m_v += node.m_im * impulses[of.first + n];
      impulses[of.first + n].setZero();
      if (!of.elastic) node.m_effectiveMass_inv = btMatrix3x3::getIdentity() * node.m_im;
    }
  }
}

void DeformableSolver::Parts::predict(SolvedBody& of, ParallelFor* inner) {
  Dynamics& dynamics = *of.dynamics;
  const auto seconds = static_cast<double>(dt());
  dynamics.predict(seconds, inner);
  dynamics.matrix().free();
  dynamics.start(seconds, inner);
  if (!of.elastic) return;
  elastic_detail::SolveLimits limits;
  limits.tolerance = of.limits->tolerance;
  limits.iterations = of.limits->iterations;
  limits.floor = std::max(kUnseen * seconds, dynamics.roundingSpeed(seconds));
  limits.enough = limits.tolerance * limits.tolerance * dynamics.squaredDeviation();
  of.solve->start({&dynamics.matrix()}, limits, {}, inner);
  of.solve->iterate(wasTouched(of) ? kIterationsBeforeContacts : limits.iterations, inner);
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
void DeformableSolver::Parts::predictPositions(SolvedBody& of) const {
  prepareStep(*of.body, dt());
  const double squaredSpeed = moveNodes(*of.body, dt());
  of.paddedTrees->fit(*of.body, *of.dynamics, static_cast<btScalar>(std::sqrt(squaredSpeed)) * dt());
}

}  // namespace tetskin
