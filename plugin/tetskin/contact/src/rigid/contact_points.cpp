// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBackwardEulerObjective.h>
#include <tetskin/bullet/src/shared/solver/required_solver.h>
#include <tetskin/contact/src/rigid/contact_points.h>

#include <algorithm>
#include <unordered_set>

namespace tetskin {
namespace {

using Constraints = btAlignedObjectArray<btDeformableNodeRigidContactConstraint>;

/// Those of the last solve; null where the body had no part in it.
const Constraints* constraintsOf(const btSoftBody& body) {
  auto* solver = static_cast<btDeformableBodySolver*>(const_cast<btSoftBody&>(body).getSoftBodySolver());
  if (!solver || !body.isActive()) return nullptr;
  const btDeformableContactProjection& projection = solver->m_objective->m_projection;
  const auto& bodies = projection.m_softBodies;
  for (int b = 0; b < std::min(bodies.size(), projection.m_nodeRigidConstraints.size()); ++b) {
    if (bodies[b] == &body) return &projection.m_nodeRigidConstraints[b];
  }
  return nullptr;
}

/// By Bullet's own solve of contacts.
std::vector<btVector3> bulletsImpulses(const btSoftBody& body) {
  const int count = body.m_nodeRigidContacts.size();
  std::vector<btVector3> impulses(static_cast<std::size_t>(count), btVector3(0, 0, 0));
  const Constraints* constraints = constraintsOf(body);
  for (int k = 0; constraints && count > 0 && k < constraints->size(); ++k) {
    const btDeformableNodeRigidContactConstraint& solved = (*constraints)[k];
    const auto at = solved.getContact() - &body.m_nodeRigidContacts[0];
    if (at < 0 || at >= count || !solved.m_binding) continue;
    const btVector3 change = solved.m_total_normal_dv + solved.m_total_tangent_dv;
    impulses[static_cast<std::size_t>(at)] = solved.getContact()->m_c5.inverse() * change;
  }
  return impulses;
}

/// By contact of the body. What the solver has found a node to be pushed with, its first contact has.
std::vector<btVector3> impulsesOn(const btSoftBody& body) {
  const DeformableSolver* solver = deformableSolverOf(body);
  std::vector<btVector3> impulses = bulletsImpulses(body);
  if (!solver || !body.isActive()) return impulses;
  std::unordered_set<const btSoftBody::Node*> told;
  for (int k = 0; k < body.m_nodeRigidContacts.size(); ++k) {
    const auto& contact = body.m_nodeRigidContacts[k];
    btVector3& impulse = impulses[static_cast<std::size_t>(k)];
    const bool pushes = !impulse.isZero() && told.insert(contact.m_node).second;
    const int node = static_cast<int>(contact.m_node - &body.m_nodes[0]);
    impulse = (pushes ? solver->normalImpulse(body, node) : btScalar(0)) * contact.m_cti.m_normal;
  }
  return impulses;
}

}  // namespace

std::vector<SurfaceContactPoint> contactPoints(const BodyContacts& contacts) {
  const btSoftBody& body = contacts.body();
  const std::vector<btVector3> impulses = impulsesOn(body);
  const std::vector<NodeTouch>& touches = contacts.touches();
  std::vector<SurfaceContactPoint> points;
  std::vector<std::uint32_t> numbers;
  for (std::size_t k = 0; k < std::min(touches.size(), impulses.size()); ++k) {
    if (touches[k].node < 0) continue;
    const auto& bullets = body.m_nodeRigidContacts[static_cast<int>(k)];
    std::size_t at = 0;
    while (at < points.size() && !(numbers[at] == touches[k].point && points[at].object == bullets.m_cti.m_colObj))
      ++at;
    if (at == points.size()) {
      numbers.push_back(touches[k].point);
      points.push_back(
          {touches[k].position, touches[k].normal, touches[k].distance, bullets.m_cti.m_colObj, btVector3(0, 0, 0)});
    }
    points[at].impulse += impulses[k];
  }
  return points;
}

}  // namespace tetskin
