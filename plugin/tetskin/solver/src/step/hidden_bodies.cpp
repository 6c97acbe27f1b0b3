// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/step/hidden_bodies.h>

#include <cassert>

namespace tetskin::bullet_detail {

void HiddenBodies::hide(const std::vector<SolvedBody>& bodies, btScalar dt) {
  assert(hidden_.empty());
  for (const SolvedBody& solved : bodies) {
    btSoftBody& body = *solved.body;
    const bool hides = body.isActive() && !collidesWithSoftBodies(body);
    if (!hides) {
      solved.memory->paddedTrees.forget();  // because Bullet fits them without padding
      continue;
    }
    solved.memory->paddedTrees.fitAgain(body, *solved.dynamics, btSqrt(body.m_maxSpeedSquared) * dt);
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

}  // namespace tetskin::bullet_detail
