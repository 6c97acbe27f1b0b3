// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The effect of forces other than elasticity in a step: Bullet's, the application's, and those that couple bodies.
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/step.h>

#include <cassert>

namespace tetskin {

/// Like btDeformableBackwardEulerObjective::applyExplicitForce, with elastic forces taken explicitly.
void DeformableSolver::Impl::applyOthers() {
  for (SolvedBody& body : bodies.bodies()) {
    if (body.needsDeformation) body.body->advanceDeformation();
  }
  VectorStack& impulses = solver.m_residual;
  for (int i = 0; i < forces().size(); ++i) forces()[i]->addScaledExplicitForce(dt(), impulses);
  for (SolvedBody& body : bodies.bodies()) {
    for (int n = 0; n < body.body->m_nodes.size(); ++n) {
      btSoftBody::Node& node = body.body->m_nodes[n];
      node.m_vn = node.m_v;
      node.m_v += node.m_im * impulses[body.first + n];
      impulses[body.first + n].setZero();
      if (!body.elastic) node.m_effectiveMass_inv = btMatrix3x3::getIdentity() * node.m_im;
    }
  }
}

/// Like btDeformableBackwardEulerObjective::computeResidual.
void DeformableSolver::Impl::addOthers() {
  for (int i = 0; i < forces().size(); ++i) {
    btDeformableLagrangianForce& force = *forces()[i];
    if (!takesPart(force)) continue;
    if (force.getForceType() == BT_MOUSE_PICKING_FORCE) {
      force.addScaledForces(dt(), solver.m_residual);
    } else {
      force.addScaledDampingForce(dt(), solver.m_residual);
    }
  }
}

void DeformableSolver::Impl::multiplySolutions(const SolvedSystem& system) {
  assert(!system.forces.empty());
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = bodies.bodies()[b];
    const auto& matrix = body.dynamics->matrix();
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      const int number = body.first + static_cast<int>(n);
      step[number] = fromPoint(body.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n)) -
                     solver.m_backupVelocity[number];
    }
  }
  multiplyOthers(system);
}

void DeformableSolver::Impl::addOtherResiduals(const SolvedSystem& system, std::size_t b) {
  const SolvedBody& body = bodies.bodies()[b];
  auto& matrix = body.dynamics->matrix();
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    const std::size_t wide = matrix.wideOf(n);
    btVector3 residual = fromWide(matrix.residual() + wide) + solver.m_residual[body.first + static_cast<int>(n)];
    if (!system.forces.empty()) residual -= fromWide(&extras[b][wide]);
    toWide(residual, matrix.residual() + wide);
  }
}

void DeformableSolver::Impl::multiplySteps(const SolvedSystem& system) {
  assert(!system.forces.empty() && extras.size() == bodies.bodies().size());
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = bodies.bodies()[b];
    const auto& matrix = body.dynamics->matrix();
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      step[body.first + static_cast<int>(n)] = fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(n));
    }
  }
  multiplyOthers(system);
}

void DeformableSolver::Impl::multiplyOthers(const SolvedSystem& system) {
  assert(extras.size() == bodies.bodies().size() && step.size() == image.size());
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = bodies.bodies()[b];
    for (int n = 0; n < body.body->m_nodes.size(); ++n) image[body.first + n].setZero();
  }
  for (btDeformableLagrangianForce* force : system.forces) {
    force->addScaledDampingForceDifferential(-dt(), step, image);
    if (force->getForceType() == BT_MOUSE_PICKING_FORCE) {
      force->addScaledElasticForceDifferential(-dt() * dt(), step, image);
    }
  }
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = bodies.bodies()[b];
    const auto& matrix = body.dynamics->matrix();
    extras[b].resize(matrix.wideSize(), btScalar(0));
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      toWide(image[body.first + static_cast<int>(n)], &extras[b][matrix.wideOf(n)]);
    }
  }
}

}  // namespace tetskin
