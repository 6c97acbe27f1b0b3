// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/motion/rigid_forces.h>

#include <algorithm>

namespace tetskin::bullet_detail {

void RigidForces::begin() {
  before_.clear();
  for (int i = 0; i < bodies_.size(); ++i) {
    before_.push_back({bodies_[i], bodies_[i]->getLinearVelocity(), bodies_[i]->getAngularVelocity()});
  }
}

RigidForces::Before* RigidForces::noted(int number) {
  const auto same = static_cast<std::size_t>(number);
  if (same < before_.size() && before_[same].body == bodies_[number]) return &before_[same];
  // A callback of the application has added or removed bodies.
  const auto found = std::find_if(before_.begin(), before_.end(),
                                  [&](const Before& before) { return before.body == bodies_[number]; });
  return found == before_.end() ? nullptr : &*found;
}

void RigidForces::afterPrediction(btScalar seconds) {
  for (int i = 0; i < bodies_.size(); ++i) {
    btRigidBody& body = *bodies_[i];
    Before* before = noted(i);
    if (!before || body.isStaticOrKinematicObject()) continue;
    body.setLinearVelocity(before->velocity);
    body.setAngularVelocity(before->turning);
    body.applyDamping(seconds);
    before->hasGravity = body.isActive();
    if (before->hasGravity) body.applyGravity();
  }
}

void RigidForces::end() {
  for (int i = 0; i < bodies_.size(); ++i) {
    const Before* before = noted(i);
    if (before && before->hasGravity) bodies_[i]->clearGravity();
  }
  before_.clear();
}

}  // namespace tetskin::bullet_detail
