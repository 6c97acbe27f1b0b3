// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What Bullet calls. What it comes to is in step.cpp.
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/shared/bodies/contact_filter.h>
#include <tetskin/bullet/src/solver/step.h>

namespace tetskin {
namespace {

template <class Constraint>
void dropAll(btAlignedObjectArray<Constraint>& constraints) {
  while (constraints.size() > 0) constraints.pop_back();
}

}  // namespace

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
int DeformableSolver::passes() const {
  return parts_->passes;
}
int DeformableSolver::unconverged() const {
  return parts_->unconverged;
}

void DeformableSolver::reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) {
  parts_->gather(softBodies, dt);
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
  parts.solving ? parts.predict() : btDeformableBodySolver::predictMotion(dt);
}

/// Of a body and a rigid object whose boxes overlap.
void DeformableSolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* object) {
  if (parts_->solving) {
    if (!body->isActive() || !meetsRigid(*body, *object->getCollisionObject())) return;
    parts_->obstacleChanges.notice(*body, *object);
  }
  btDeformableBodySolver::processCollision(body, object);
}

void DeformableSolver::setupDeformableSolve(bool implicit) {
  btDeformableBodySolver::setupDeformableSolve(implicit && !parts_->solving);
}

/// Rows are solved for here; Bullet's own of the same nodes would be a second time.
void DeformableSolver::setConstraints(const btContactSolverInfo& info) {
  btDeformableBodySolver::setConstraints(info);
  if (!parts_->solving) return;
  btDeformableContactProjection& projection = m_objective->m_projection;
  for (std::size_t b = 0; b < parts_->bodies.bodies().size(); ++b) {
    if (!parts_->bodies.bodies()[b].elastic) continue;
    const auto at = static_cast<int>(b);
    dropAll(projection.m_nodeRigidConstraints[at]);
    dropAll(projection.m_nodeAnchorConstraints[at]);
    dropAll(projection.m_faceRigidConstraints[at]);
  }
}

/// What a world without projection asks for.
void DeformableSolver::setLagrangeMultiplier() {
  parts_->solving ? setProjection() : btDeformableBodySolver::setLagrangeMultiplier();
}

void DeformableSolver::solveDeformableConstraints(btScalar dt) {
  Parts& parts = *parts_;
  if (!parts.solving) {
    parts.iterations = parts.passes = parts.unconverged = 0;
    return btDeformableBodySolver::solveDeformableConstraints(dt);
  }
  parts.assemble();
  parts.solve();
  parts.finishContacts();
  parts.writeBack();
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
