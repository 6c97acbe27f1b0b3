// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The positions at the end of a step. Bullet moves the nodes in its own precision; they then get the positions that the
// dynamics hold in double, unless something else has moved them. Bullet puts anchored nodes where their anchors are;
// they get their own positions back, too, so that a loaded anchor is at rest: otherwise its nodes would fall back in
// each step, and the damping of their velocity would push what hangs on them.
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/step/step.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Relative to the body's size: rounding of positions below this is not visible.
constexpr btScalar kVisible = btScalar(1e-5);

/// False if the application has appended nodes within the step.
bool hasItsNodes(const SolvedBody& solved) {
  return solved.dynamics->nodeCount() == static_cast<std::size_t>(solved.body->m_nodes.size());
}

/// True if something has moved the node since the step began.
bool isElsewhere(const btSoftBody::Node& node, const btScalar* point) {
  return node.m_x.x() != point[0] || node.m_x.y() != point[1] || node.m_x.z() != point[2];
}

}  // namespace

void DeformableSolver::Impl::listForeignNodes(SolvedBody& body) const {
  assert(stage == Stage::WriteBack);
  body.positions.foreign.clear();
  if (!body.elastic || !hasItsNodes(body)) return;
  for (int n = 0; n < body.body->m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.body->m_nodes[n];
    if (isElsewhere(node, body.dynamics->point(static_cast<std::size_t>(n)))) body.positions.foreign.push_back(n);
  }
}

void DeformableSolver::Impl::findShaken() {
  assert(stage >= Stage::Solve);  // rows are final
  for (SolvedBody& body : bodies.bodies()) body.positions.shaken = false;
  for (const ContactRow& row : rows.rows()) {
    if (!row.ends[0].isSoft() || !row.ends[1].isSoft() || row.joined) continue;
    for (const RowEnd& end : row.ends) {
      SolvedBody& solved = bodies.bodies()[end.body];
      const btVector3 far = solved.body->m_bounds[0].absolute() + solved.body->m_bounds[1].absolute();
      solved.positions.shaken = SIMD_EPSILON * far[far.maxAxis()] > kVisible * sizeOf(*solved.body);
    }
  }
}

/// Uses the velocities that Bullet has used, because it bounds them.
void DeformableSolver::Impl::refinePositions(btScalar dt) {
  if (!solving || !inStep()) return;
  assert(stage == Stage::WriteBack && dt > 0);
  for (const SolvedBody& solved : bodies.bodies()) {
    if (!solved.elastic || !hasItsNodes(solved)) continue;
    auto foreign = solved.positions.foreign.begin();
    for (int n = 0; n < solved.body->m_nodes.size(); ++n) {
      if (foreign != solved.positions.foreign.end() && *foreign == n) {
        ++foreign;
        continue;
      }
      btSoftBody::Node& node = solved.body->m_nodes[n];
      const auto at = static_cast<std::size_t>(n);
      btVector3 v = node.m_v + node.m_splitv;
      if (node.m_im == btScalar(0) && v.isZero()) continue;
      if (solved.positions.shaken) v = movingComponent(fromPoint(solved.dynamics->point(at)), v, dt);
      btScalar by[3];
      toPoint(v, by);
      node.m_x = node.m_q = fromPoint(solved.dynamics->advance(at, static_cast<double>(dt), by));
    }
  }
}

}  // namespace tetskin
