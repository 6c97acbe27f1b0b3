// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/src/shared/forces/body_forces.h>
#include <tetskin/touch/src/forces/touch_force.h>

#include <algorithm>
#include <map>

namespace tetskin::touch_detail {

TouchForce::~TouchForce() {
  // What is left are forces on bodies that are still there: by them it is known whether the list is, too.
  const bool inWorld = std::any_of(parts_.begin(), parts_.end(), [&](const auto& part) {
    const btSoftBody* body = part->body();
    return body && body->getBroadphaseHandle() && body->getSoftBodySolver() == &solver_;
  });
  if (inWorld) leave();
}

std::shared_ptr<TouchForce> TouchForce::of(DeformableSolver& solver) {
  const auto& list = *solver.getLagrangianForceArray();
  for (int i = 0; i < list.size(); ++i) {
    if (auto* found = dynamic_cast<TouchForce*>(list[i])) return found->shared_from_this();
  }
  return std::make_shared<TouchForce>(solver);
}

void TouchForce::add(std::shared_ptr<Acting> part) {
  solver_.solveAlways();
  parts_.push_back(std::move(part));
  if (listed_) return;
  listed_ = true;
  setIndices(solver_.getIndices());
  solver_.getLagrangianForceArray()->push_back(this);
}

void TouchForce::remove(const Acting& part) {
  const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const auto& of) { return of.get() == &part; });
  if (found == parts_.end()) return;
  parts_.erase(found);
  if (parts_.empty()) leave();
}

void TouchForce::watch(btDiscreteDynamicsWorld& world) {
  if (world_) return;
  world_ = &world;
  world.addAction(this);
}

/// Bullet may be walking over the list.
void TouchForce::leave() {
  if (world_) world_->removeAction(this);
  world_ = nullptr;
  if (listed_) replaceByNothing(*solver_.getLagrangianForceArray(), this);
  listed_ = false;
  pairs_.clear();
}

void TouchForce::removeSoftBody(btSoftBody* body) {
  removal_ = true;
  for (const auto& part : parts_) {
    if (part->body() == body) part->drop();
  }
  eraseSpent();
}

void TouchForce::eraseSpent() {
  parts_.erase(std::remove_if(parts_.begin(), parts_.end(), [](const auto& part) { return part->spent(); }),
               parts_.end());
  if (parts_.empty()) leave();
}

void TouchForce::reinitialize(bool) {
  const bool removal = removal_;
  removal_ = false;
  if (removal) return;
  eraseSpent();
  beginAll(solver_.m_objective->m_dt);
}

void TouchForce::beginAll(btScalar dt) {
  pairs_.clear();
  std::map<const void*, int> sharers;
  for (const auto& part : parts_) ++sharers[part->partner()];
  for (const auto& part : parts_) {
    part->begin(dt, sharers[part->partner()]);
    btSoftBody* body = part->body();
    if (body && body->isActive()) pairs_.push_back({body, body});
  }
}

void TouchForce::addScaledDampingForce(btScalar, TVStack& force) {
  for (const auto& part : parts_) part->addTo(force);
}

void TouchForce::addScaledDampingForceDifferential(btScalar, const TVStack& dv, TVStack& df) {
  for (const auto& part : parts_) part->addResistance(dv, df);
}

void TouchForce::updateAction(btCollisionWorld*, btScalar) {
  for (const auto& part : parts_) part->finish();
}

}  // namespace tetskin::touch_detail
