// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/solver/padded_trees.h>
#include <tetskin/bullet/src/solver/solver_bodies.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Padding of the leaves of a body's trees, in collision margins: with a larger one, contact searches visit more
/// leaves, and the trees are refitted less often.
constexpr btScalar kPadding = 2;

}  // namespace

bool collidesWithSoftBodies(btSoftBody& body) {
  return (body.m_cfg.collisions & btSoftBody::fCollision::SVSmask) != 0 || body.useSelfCollision();
}

bool collidesByFaces(btSoftBody& body) {
  constexpr int kFaces = btSoftBody::fCollision::SDF_RDF | btSoftBody::fCollision::SDF_MDF;
  return (body.m_cfg.collisions & kFaces) != 0 || collidesWithSoftBodies(body);
}

void PaddedTrees::fit(btSoftBody& body, Dynamics& dynamics, btScalar step) {
  assert(dynamics.nodeCount() == static_cast<std::size_t>(body.m_nodes.size()));
  const btScalar margin = body.getCollisionShape()->getMargin();
  if (pad != kPadding * margin) ready = false;
  pad = kPadding * margin;
  drift = ready ? furthest(dynamics) : pad;
  if (holds(step)) return;
  body.m_sst.radmrg = pad;
  body.updateNodeTree(true, true);
  if (!body.m_fdbvt.empty()) body.updateFaceTree(true, true);
  body.m_sst.radmrg = margin;
  keep(dynamics);
}

void PaddedTrees::fitBefore(btSoftBody& body, btScalar step) {
  if (holds(step)) return;
  body.updateNodeTree(true, false);
  if (!body.m_fdbvt.empty()) body.updateFaceTree(true, false);
  ready = false;
}

void PaddedTrees::keep(Dynamics& dynamics) {
  points.resize(3 * dynamics.nodeCount());
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) std::copy_n(dynamics.point(n), 3, &points[3 * n]);
  drift = 0;
  ready = true;
}

btScalar PaddedTrees::furthest(Dynamics& dynamics) const {
  assert(points.size() == 3 * dynamics.nodeCount());
  btScalar maximum = 0;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btScalar* now = dynamics.point(n);
    const btScalar x = now[0] - points[3 * n], y = now[1] - points[3 * n + 1], z = now[2] - points[3 * n + 2];
    maximum = std::max(maximum, x * x + y * y + z * z);
  }
  return btSqrt(maximum);
}

void HiddenBodies::hide(const std::vector<SolvedBody>& bodies, btScalar dt) {
  assert(hidden_.empty());
  for (const SolvedBody& solved : bodies) {
    btSoftBody& body = *solved.body;
    const bool hides = body.isActive() && !collidesWithSoftBodies(body);
    if (!hides) {
      solved.paddedTrees->ready = false;  // because Bullet fits them without padding
      continue;
    }
    solved.paddedTrees->fitBefore(body, btSqrt(body.m_maxSpeedSquared) * dt);
    hidden_.emplace_back(&body, body.getActivationState());
    body.forceActivationState(ISLAND_SLEEPING);
  }
}

void HiddenBodies::show(const btAlignedObjectArray<btSoftBody*>& alive) {
  for (const auto& [body, state] : hidden_) {
    if (alive.findLinearSearch(body) == alive.size()) continue;
    if (body->getActivationState() == ISLAND_SLEEPING) body->forceActivationState(state);
  }
  hidden_.clear();
}

}  // namespace tetskin
