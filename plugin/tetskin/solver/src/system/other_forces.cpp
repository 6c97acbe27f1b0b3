// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/other_forces.h>

#include <cassert>

namespace tetskin::bullet_detail {

void OtherForces::beginStep(const SolverBodies& bodies, const VectorStack& impulses, const VectorStack& before,
                            btScalar seconds) {
  assert(seconds > 0 && impulses.size() == before.size());
  bodies_ = &bodies.bodies();
  impulses_ = &impulses;
  before_ = &before;
  seconds_ = seconds;
  factor_.resize(bodies.nodeCount(), btVector3(0, 0, 0));
  image_.resize(bodies.nodeCount(), btVector3(0, 0, 0));
  products_.resize(bodies_->size());
}

void OtherForces::multiplySolutions(const SolvedSystem& system) {
  assert(!system.forces.empty());
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = (*bodies_)[b];
    const auto& matrix = body.dynamics->matrix();
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      const int number = body.first + static_cast<int>(n);
      factor_[number] =
          fromPoint(body.dynamics->velocity(n)) + fromWide(matrix.solution() + matrix.wideOf(n)) - (*before_)[number];
    }
  }
  multiply(system);
}

void OtherForces::multiplySteps(const SolvedSystem& system) {
  assert(!system.forces.empty() && products_.size() == bodies_->size());
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = (*bodies_)[b];
    const auto& matrix = body.dynamics->matrix();
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      factor_[body.first + static_cast<int>(n)] = fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(n));
    }
  }
  multiply(system);
}

/// Computes the products of the forces' derivatives with `factor_`.
void OtherForces::multiply(const SolvedSystem& system) {
  assert(products_.size() == bodies_->size() && factor_.size() == image_.size());
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = (*bodies_)[b];
    for (int n = 0; n < body.body->m_nodes.size(); ++n) image_[body.first + n].setZero();
  }
  for (btDeformableLagrangianForce* force : system.forces) {
    force->addScaledDampingForceDifferential(-seconds_, factor_, image_);
    if (force->getForceType() == BT_MOUSE_PICKING_FORCE) {
      force->addScaledElasticForceDifferential(-seconds_ * seconds_, factor_, image_);
    }
  }
  for (const std::size_t b : system.bodies) {
    const SolvedBody& body = (*bodies_)[b];
    const auto& matrix = body.dynamics->matrix();
    products_[b].resize(matrix.wideSize(), btScalar(0));
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      toWide(image_[body.first + static_cast<int>(n)], &products_[b][matrix.wideOf(n)]);
    }
  }
}

void OtherForces::addResiduals(const SolvedSystem& system, std::size_t b) const {
  const SolvedBody& body = (*bodies_)[b];
  auto& matrix = body.dynamics->matrix();
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    const std::size_t wide = matrix.wideOf(n);
    btVector3 residual = fromWide(matrix.residual() + wide) + (*impulses_)[body.first + static_cast<int>(n)];
    if (!system.forces.empty()) residual -= fromWide(&products_[b][wide]);
    toWide(residual, matrix.residual() + wide);
  }
}

}  // namespace tetskin::bullet_detail
