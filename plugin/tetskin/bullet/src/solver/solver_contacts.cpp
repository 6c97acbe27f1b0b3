// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>

#include <algorithm>

namespace tetskin {
namespace {

std::size_t placeIn(const SolvedBody& of, int node) {
  return static_cast<std::size_t>(node - of.first);
}

void fix(Dynamics& dynamics, std::size_t node, const btAlignedObjectArray<btVector3>& directions) {
  auto& matrix = dynamics.matrix();
  if (directions.size() >= 3) return matrix.fix(node);
  btVector3 free = directions.size() == 2 ? directions[0].cross(directions[1]) : btVector3(0, 0, 0);
  if (free.length2() < SIMD_EPSILON) return matrix.fixAlong(node, directions[0].m_floats);
  free.normalize();
  matrix.fixAllBut(node, free.m_floats);
}

/// The normal impulse that friction is bounded by: that of the step before, but no more than what it took in this one
/// to stop the node with all that hangs on it, and no less than what stops the node alone.
btScalar normalImpulse(const SolvedBody& of, std::size_t node, const btVector3& normal, btScalar along, btScalar mass) {
  btScalar d[6];
  of.dynamics->matrix().diagonal(node, d);
  const btScalar effective =
      d[0] * normal[0] * normal[0] + d[3] * normal[1] * normal[1] + d[5] * normal[2] * normal[2] +
      2 * (d[1] * normal[0] * normal[1] + d[2] * normal[0] * normal[2] + d[4] * normal[1] * normal[2]);
  return std::max(std::min((*of.normalImpulses)[node], effective * along), mass * along);
}

/// Friction of one sliding contact as resistance, of the coefficient's force at the speed that it has. It only ever
/// takes energy away: forces, as Bullet's are, push nodes that hang together back to where they came from, and explode.
void resist(SolvedBody& of, const btDeformableNodeRigidContactConstraint& constraint, VectorStack& residual) {
  const btSoftBody::Node& bullets = *constraint.m_node;
  const btVector3 dv = constraint.getDv(&bullets), normal = constraint.m_contact->m_cti.m_normal;
  if (bullets.m_im == 0 || dv.isZero() || isNoNumber(dv) || constraint.m_static) return;
  const std::size_t node = placeIn(of, bullets.index);
  const btScalar along = dv.dot(normal), mass = 1 / bullets.m_im;
  // Where it binds, the node's normal velocity is fixed.
  if (!constraint.m_binding) residual[bullets.index] += along * mass * normal;
  of.touched = true;
  const btScalar* v = of.dynamics->velocity(node);
  const btVector3 relative = btVector3(v[0], v[1], v[2]) - constraint.getVa();
  const btVector3 sliding = relative - relative.dot(normal) * normal;
  const btScalar impulse = constraint.m_contact->m_c3 * normalImpulse(of, node, normal, along, mass);
  const btScalar speed = std::max(sliding.length(), btScalar(1e-6));
  if (!(impulse > 0)) return;
  of.dynamics->matrix().resistAcross(node, normal.m_floats, impulse / speed);
  residual[bullets.index] -= impulse / speed * sliding;
}

}  // namespace

void fixContacts(const btDeformableContactProjection& projection, SolverBodies& bodies) {
  const auto& fixed = projection.m_projectionsDict;
  for (int k = 0; k < fixed.size(); ++k) {
    const int node = fixed.getKeyAtIndex(k).getUid1();
    SolvedBody& of = bodies.bodyOf(node);
    const std::size_t place = placeIn(of, node);
    if (of.dynamics->matrix().mass(place) == 0) continue;
    fix(*of.dynamics, place, *fixed.getAtIndex(k));
    of.constrained = true;
  }
}

void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies, VectorStack& residual) {
  const auto add = [&](const auto& constraint, const btSoftBody::Node& node) {
    const btVector3 dv = constraint.getDv(&node);
    if (node.m_im == 0 || isNoNumber(dv)) return;
    residual[node.index] += dv / node.m_im;
    bodies.bodyOf(node.index).touched = true;
  };
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    SolvedBody& of = bodies.bodies()[b];
    const auto& nodes = projection.m_nodeRigidConstraints[static_cast<int>(b)];
    for (int k = 0; k < nodes.size(); ++k) {
      const btSoftBody::Node& node = *nodes[k].m_node;
      of.elastic ? resist(of, nodes[k], residual) : add(nodes[k], node);
    }
    const auto& faces = projection.m_faceRigidConstraints[static_cast<int>(b)];
    for (int k = 0; k < faces.size(); ++k) {
      for (const btSoftBody::Node* node : faces[k].getContact()->m_face->m_n) add(faces[k], *node);
    }
    const auto& pairs = projection.m_deformableConstraints[static_cast<int>(b)];
    for (int k = 0; k < pairs.size(); ++k) {
      add(pairs[k], *pairs[k].getContact()->m_node);
      for (const btSoftBody::Node* node : pairs[k].getContact()->m_face->m_n) add(pairs[k], *node);
    }
  }
}

void keepNormalImpulses(const btDeformableContactProjection& projection, SolverBodies& bodies,
                        const VectorStack& residual) {
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    const SolvedBody& of = bodies.bodies()[b];
    if (!of.elastic) continue;
    std::fill(of.normalImpulses->begin(), of.normalImpulses->end(), btScalar(0));
    const auto& contacts = projection.m_nodeRigidConstraints[static_cast<int>(b)];
    for (int k = 0; k < contacts.size(); ++k) {
      if (!contacts[k].m_binding) continue;
      const int number = contacts[k].m_node->index;
      const std::size_t node = placeIn(of, number);
      // What the contact had to add to the momentum equation.
      btScalar image[3], own[3];
      of.dynamics->matrix().rowTimesSolution(node, image);
      of.dynamics->rightSide(node, own);
      const btVector3 reaction = btVector3(image[0] - own[0], image[1] - own[1], image[2] - own[2]) - residual[number];
      btScalar& kept = (*of.normalImpulses)[node];
      kept = std::max(kept, reaction.dot(contacts[k].m_contact->m_cti.m_normal));
    }
  }
}

}  // namespace tetskin
