// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/solver/padded_trees.h>
#include <tetskin/bullet/src/solver/solver_bodies.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

/// Of the leaves of a body's trees, in collision margins: more is to be looked at for contacts, less often to be
/// fitted.
constexpr btScalar kPadding = 2;

}  // namespace

bool meetsSoftBodies(btSoftBody& body) {
  return (body.m_cfg.collisions & btSoftBody::fCollision::SVSmask) != 0 || body.useSelfCollision();
}

bool meetsByFaces(btSoftBody& body) {
  constexpr int kFaces = btSoftBody::fCollision::SDF_RDF | btSoftBody::fCollision::SDF_MDF;
  return (body.m_cfg.collisions & kFaces) != 0 || meetsSoftBodies(body);
}

void PaddedTrees::fit(btSoftBody& body, Dynamics& dynamics, btScalar step) {
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
  btScalar most = 0;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btScalar* now = dynamics.point(n);
    const btScalar x = now[0] - points[3 * n], y = now[1] - points[3 * n + 1], z = now[2] - points[3 * n + 2];
    most = std::max(most, x * x + y * y + z * z);
  }
  return btSqrt(most);
}

void HiddenBodies::hide(const std::vector<SolvedBody>& bodies, btScalar dt) {
  for (const SolvedBody& of : bodies) {
    btSoftBody& body = *of.body;
    const bool hides = body.isActive() && !meetsSoftBodies(body);
    if (!hides) {
      of.paddedTrees->ready = false;  // Bullet fits them tightly
      continue;
    }
    of.paddedTrees->fitBefore(body, btSqrt(body.m_maxSpeedSquared) * dt);
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
