// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What other forces than elasticity do in a step: Bullet's, the application's, and those that couple bodies.
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/step.h>

namespace tetskin {

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
      node.m_vn = node.m_v;
      node.m_v += node.m_im * impulses[of.first + n];
      impulses[of.first + n].setZero();
      if (!of.elastic) node.m_effectiveMass_inv = btMatrix3x3::getIdentity() * node.m_im;
    }
  }
}

/// As btDeformableBackwardEulerObjective::computeResidual.
void DeformableSolver::Parts::addOthers() {
  for (int i = 0; i < forces().size(); ++i) {
    btDeformableLagrangianForce& force = *forces()[i];
    if (force.getForceType() == BT_MOUSE_PICKING_FORCE) {
      force.addScaledForces(dt(), solver.m_residual);
    } else {
      force.addScaledDampingForce(dt(), solver.m_residual);
    }
  }
}

void DeformableSolver::Parts::addOtherResiduals(const SolvedSystem& system) {
  const bool withForces = !system.forces.empty();
  if (withForces) {
    for (const std::size_t b : system.bodies) {
      const SolvedBody& of = bodies.bodies()[b];
      const auto& matrix = of.dynamics->matrix();
      for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
        const int number = of.first + static_cast<int>(n);
        step[number] = fromPoint(of.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n)) -
                       solver.m_backupVelocity[number];
      }
    }
    multiplyOthers(system);
  }
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    auto& matrix = of.dynamics->matrix();
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      const std::size_t wide = matrix.wideOf(n);
      btVector3 residual = fromWide(matrix.residual() + wide) + solver.m_residual[of.first + static_cast<int>(n)];
      if (withForces) residual -= fromWide(&extras[b][wide]);
      toWide(residual, matrix.residual() + wide);
    }
  }
}

void DeformableSolver::Parts::beginProducts(const SolvedSystem& system) {
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    const auto& matrix = of.dynamics->matrix();
    if (system.forces.empty()) {
      extras[b].assign(matrix.wideSize(), btScalar(0));
      continue;
    }
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      step[of.first + static_cast<int>(n)] = fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(n));
    }
  }
  if (!system.forces.empty()) multiplyOthers(system);
}

void DeformableSolver::Parts::multiplyOthers(const SolvedSystem& system) {
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    for (int n = 0; n < of.body->m_nodes.size(); ++n) image[of.first + n].setZero();
  }
  for (btDeformableLagrangianForce* force : system.forces) {
    force->addScaledDampingForceDifferential(-dt(), step, image);
    if (force->getForceType() == BT_MOUSE_PICKING_FORCE) {
      force->addScaledElasticForceDifferential(-dt() * dt(), step, image);
    }
  }
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    const auto& matrix = of.dynamics->matrix();
    extras[b].resize(matrix.wideSize(), btScalar(0));
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      toWide(image[of.first + static_cast<int>(n)], &extras[b][matrix.wideOf(n)]);
    }
  }
}

}  // namespace tetskin
