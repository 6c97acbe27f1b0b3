// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/src/shared/forces/body_forces.h>
#include <tetskin/touch/src/forces/touch_force.h>

#include <algorithm>

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

/// Bullet may be walking over the list.
void TouchForce::leave() {
  if (listed_) replaceByNothing(*solver_.getLagrangianForceArray(), this);
  listed_ = false;
}

void TouchForce::removeSoftBody(btSoftBody* body) {
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

std::vector<PointJoint>* TouchForce::joints(btScalar seconds) {
  eraseSpent();
  joints_.clear();
  firsts_.clear();
  for (const auto& part : parts_) {
    firsts_.push_back(joints_.size());
    part->addJoints(seconds, joints_);
  }
  return &joints_;
}

void TouchForce::finish(btScalar seconds) {
  for (std::size_t k = 0; k < firsts_.size(); ++k) parts_[k]->finish(seconds, joints_.data() + firsts_[k]);
  firsts_.clear();
}

}  // namespace tetskin::touch_detail
