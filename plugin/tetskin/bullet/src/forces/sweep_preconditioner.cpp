// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/forces/sweep_preconditioner.h>

namespace tetskin {
namespace {

void sweep(const ForcedBody& of, const btAlignedObjectArray<btVector3>& x, btAlignedObjectArray<btVector3>& b) {
  auto& matrix = of.dynamics->matrix();
  const int first = of.body->m_nodes[0].index;
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    toWide(x[first + static_cast<int>(n)], matrix.residual() + matrix.wideOf(n));
  }
  matrix.lower(nullptr);
  matrix.backward(0, nullptr);
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    b[first + static_cast<int>(n)] = fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(n));
  }
}

}  // namespace

void SweepPreconditioner::add(btDeformableBackwardEulerObjective& objective, const ForcedBody& body) {
  auto* installed = dynamic_cast<SweepPreconditioner*>(objective.m_preconditioner);
  if (!installed) {
    install(objective);
    installed = this;
  }
  installed->bodies_.push_back(&body);
}

void SweepPreconditioner::install(btDeformableBackwardEulerObjective& objective) {
  objective_ = &objective;
  bodies_.clear();
  inverseMasses_.resizeNoInitialize(objective.m_nodes.size());
  for (int i = 0; i < objective.m_nodes.size(); ++i) inverseMasses_[i] = objective.m_nodes[i]->m_im;
  objective.m_preconditioner = this;
}

void SweepPreconditioner::operator()(const TVStack& x, TVStack& b) {
  for (int i = 0; i < inverseMasses_.size(); ++i) b[i] = inverseMasses_[i] * x[i];
  for (const ForcedBody* of : bodies_) sweep(*of, x, b);
  objective_->m_projection.project(b);
}

}  // namespace tetskin
