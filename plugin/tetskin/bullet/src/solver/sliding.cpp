// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/sliding.h>

#include <algorithm>

namespace tetskin {
namespace {

/// The normal impulse that friction is bounded by: that of the step before, but no more than what it took in this one
/// to stop the node with all that hangs on it, and no less than what stops the node alone.
btScalar normalImpulse(const SolvedBody& of, std::size_t node, const btVector3& normal, btScalar along, btScalar mass) {
  btScalar d[6];
  of.dynamics->matrix().diagonal(node, d);
  const btScalar effective = normal.dot(symmetricMatrix(d) * normal);
  return std::max(std::min((*of.normalImpulses)[node], effective * along), mass * along);
}

}  // namespace

SlidingFriction slidingOf(const SolvedBody& of, const btDeformableNodeRigidContactConstraint& contact) {
  const btSoftBody::Node& bullets = *contact.m_node;
  const btVector3 dv = contact.getDv(&bullets), normal = contact.m_contact->m_cti.m_normal;
  if (bullets.m_im == 0 || dv.isZero() || isNoNumber(dv) || contact.m_static) return {};
  const std::size_t node = of.placeOf(bullets.index);
  const btScalar impulse = contact.m_contact->m_c3 * normalImpulse(of, node, normal, dv.dot(normal), 1 / bullets.m_im);
  if (!(impulse > 0)) return {};
  const btVector3 relative = fromPoint(of.dynamics->velocity(node)) - contact.getVa();
  const btVector3 sliding = relative - relative.dot(normal) * normal;
  return {impulse / std::max(sliding.length(), btScalar(1e-6)), sliding};
}

btMatrix3x3 resistanceAcross(const btVector3& normal, btScalar resistance) {
  btMatrix3x3 block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block[i][j] = resistance * (btScalar(i == j) - normal[i] * normal[j]);
  }
  return block;
}

}  // namespace tetskin
