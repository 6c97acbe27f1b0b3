// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The impulses of forces other than elasticity in a step: Bullet's, and the application's.
#include <tetskin/solver/src/step/step.h>

#include <cassert>

namespace tetskin {

/// Like btDeformableBackwardEulerObjective::applyExplicitForce, with elastic forces taken explicitly.
void DeformableSolver::Impl::applyOthers() {
  for (SolvedBody& body : bodies.bodies()) {
    if (body.needsDeformation) body.body->advanceDeformation();
  }
  VectorStack& impulses = solver.m_residual;
  assert(impulses.size() >= bodies.awakeCount());
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
  assert(stage == Stage::Assemble && solver.m_residual.size() >= bodies.awakeCount());
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

}  // namespace tetskin
