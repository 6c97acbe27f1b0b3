// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/fixed_nodes.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

FixedNode fixedNode(std::size_t node, const btAlignedObjectArray<btVector3>& directions) {
  assert(directions.size() > 0);
  FixedNode fixed;
  fixed.node = node;
  if (directions.size() >= 3) return fixed;
  fixed.direction = directions.size() == 2 ? directions[0].cross(directions[1]) : btVector3(0, 0, 0);
  fixed.kind = FixedNode::AllButDirection;
  if (fixed.direction.length2() < SIMD_EPSILON) {
    fixed.direction = directions[0];
    fixed.kind = FixedNode::AlongDirection;
  } else {
    fixed.direction.normalize();
  }
  return fixed;
}

}  // namespace

void listFixedNodes(const btDeformableContactProjection& projection, SolverBodies& bodies) {
  const auto& projected = projection.m_projectionsDict;
  for (int k = 0; k < projected.size(); ++k) {
    const int number = projected.getKeyAtIndex(k).getUid1();
    SolvedBody& body = bodies.bodyOf(number);
    const std::size_t node = body.indexOf(number);
    if (body.dynamics->matrix().mass(node) != 0) body.acted.fixed.push_back(fixedNode(node, *projected.getAtIndex(k)));
  }
}

void fixNodes(const SolvedBody& body) {
  assert(body.dynamics);
  auto& matrix = body.dynamics->matrix();
  for (const FixedNode& fixed : body.acted.fixed) {
    if (fixed.kind == FixedNode::Fixed) matrix.fix(fixed.node);
    if (fixed.kind == FixedNode::AlongDirection) matrix.fixAlong(fixed.node, fixed.direction.m_floats);
    if (fixed.kind == FixedNode::AllButDirection) matrix.fixAllBut(fixed.node, fixed.direction.m_floats);
  }
}

void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies, VectorStack& residual) {
  const auto add = [&](const auto& constraint, const btSoftBody::Node& node) {
    const btVector3 dv = constraint.getDv(&node);
    if (node.m_im == 0 || isNaN(dv)) return;
    residual[node.index] += dv / node.m_im;
    bodies.bodyOf(node.index).acted.changed = true;
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

}  // namespace tetskin::bullet_detail
