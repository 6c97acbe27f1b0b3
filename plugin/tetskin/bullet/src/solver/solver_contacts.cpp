// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/rigid_ties.h>
#include <tetskin/bullet/src/solver/sliding.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>

#include <algorithm>

namespace tetskin {
namespace {

void fix(Dynamics& dynamics, std::size_t node, const btAlignedObjectArray<btVector3>& directions) {
  auto& matrix = dynamics.matrix();
  if (directions.size() >= 3) return matrix.fix(node);
  btVector3 free = directions.size() == 2 ? directions[0].cross(directions[1]) : btVector3(0, 0, 0);
  if (free.length2() < SIMD_EPSILON) return matrix.fixAlong(node, directions[0].m_floats);
  free.normalize();
  matrix.fixAllBut(node, free.m_floats);
}

void resist(SolvedBody& of, const btDeformableNodeRigidContactConstraint& constraint, VectorStack& residual) {
  const btSoftBody::Node& bullets = *constraint.m_node;
  const btVector3 dv = constraint.getDv(&bullets), normal = constraint.m_contact->m_cti.m_normal;
  if (bullets.m_im == 0 || dv.isZero() || isNoNumber(dv) || constraint.m_static) return;
  // Where it binds, the node's normal velocity is fixed.
  if (!constraint.m_binding) residual[bullets.index] += dv.dot(normal) / bullets.m_im * normal;
  of.touched = true;
  const SlidingFriction sliding = slidingOf(of, constraint);
  if (!(sliding.resistance > 0)) return;
  const btMatrix3x3 w = resistanceAcross(normal, sliding.resistance);
  const btScalar block[6] = {w[0][0], w[0][1], w[0][2], w[1][1], w[1][2], w[2][2]};
  of.dynamics->matrix().resist(of.placeOf(bullets.index), block);
  residual[bullets.index] -= sliding.resistance * sliding.velocity;
}

}  // namespace

void fixContacts(const btDeformableContactProjection& projection, const RigidTies& ties, SolverBodies& bodies) {
  const auto& fixed = projection.m_projectionsDict;
  for (int k = 0; k < fixed.size(); ++k) {
    const int node = fixed.getKeyAtIndex(k).getUid1();
    if (ties.ties(node)) continue;
    SolvedBody& of = bodies.bodyOf(node);
    const std::size_t place = of.placeOf(node);
    if (of.dynamics->matrix().mass(place) == 0) continue;
    fix(*of.dynamics, place, *fixed.getAtIndex(k));
    of.constrained = true;
  }
}

void addDynamicFriction(const btDeformableContactProjection& projection, const RigidTies& ties, SolverBodies& bodies,
                        VectorStack& residual) {
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
      if (ties.ties(node.index)) continue;
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
      const std::size_t node = of.placeOf(number);
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
