// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
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

}  // namespace

void fixContacts(const btDeformableContactProjection& projection, SolverBodies& bodies) {
  const auto& fixed = projection.m_projectionsDict;
  for (int k = 0; k < fixed.size(); ++k) {
    const int node = fixed.getKeyAtIndex(k).getUid1();
    SolvedBody& of = bodies.bodyOf(node);
    const std::size_t place = of.placeOf(node);
    if (of.dynamics->matrix().mass(place) == 0) continue;
    fix(*of.dynamics, place, *fixed.getAtIndex(k));
    of.constrained = true;
  }
}

void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies,
                        VectorStack& residual) {
  const auto add = [&](const auto& constraint, const btSoftBody::Node& node) {
    const btVector3 dv = constraint.getDv(&node);
    if (node.m_im == 0 || isNoNumber(dv)) return;
    residual[node.index] += dv / node.m_im;
    bodies.bodyOf(node.index).touched = true;
  };
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    const auto& nodes = projection.m_nodeRigidConstraints[static_cast<int>(b)];
    for (int k = 0; k < nodes.size(); ++k) {
      add(nodes[k], *nodes[k].m_node);
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

}  // namespace tetskin
