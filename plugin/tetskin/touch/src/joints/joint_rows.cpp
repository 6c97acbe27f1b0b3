// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/touch/src/joints/joint_rows.h>

#include <algorithm>
#include <cassert>

namespace tetskin::touch_detail {

using namespace bullet_detail;

SurfaceJointRows::~SurfaceJointRows() {
  leave();
}

std::shared_ptr<SurfaceJointRows> SurfaceJointRows::instanceOf(DeformableSolver& solver) {
  const auto& list = *solver.getLagrangianForceArray();
  for (int i = 0; i < list.size(); ++i) {
    if (auto* found = dynamic_cast<SurfaceJointRows*>(inactiveForce(list[i]))) return found->shared_from_this();
  }
  return std::make_shared<SurfaceJointRows>(solver);
}

void SurfaceJointRows::add(std::shared_ptr<Joint> joint) {
  assert(joint && joint->body());
  solver_.requireOwnSolve();
  active_.push_back(std::move(joint));
  if (listed_) return;
  listed_ = true;
  setIndices(solver_.getIndices());
  solver_.getLagrangianForceArray()->push_back(this);
}

void SurfaceJointRows::remove(const Joint& joint) {
  const auto found =
      std::find_if(active_.begin(), active_.end(), [&](const auto& item) { return item.get() == &joint; });
  if (found == active_.end()) return;
  active_.erase(found);
  if (active_.empty()) leave();
}

/// Bullet may be iterating over the list, which the solver owns.
void SurfaceJointRows::leave() {
  if (listed_ && deformableSolver(&solver_)) replaceByNothing(*solver_.getLagrangianForceArray(), this);
  listed_ = false;
}

void SurfaceJointRows::removeSoftBody(btSoftBody* body) {
  // A body whose destruction is noticed may come back.
  if (bodyWithTrees(*body)) return;
  for (const auto& joint : active_) {
    if (joint->body() == body) joint->drop();
  }
  eraseSpent();
}

void SurfaceJointRows::eraseSpent() {
  active_.erase(std::remove_if(active_.begin(), active_.end(), [](const auto& joint) { return !joint->body(); }),
                active_.end());
  if (active_.empty()) leave();
}

std::vector<PointJoint>* SurfaceJointRows::joints(btScalar seconds) {
  eraseSpent();
  joints_.clear();
  firsts_.clear();
  for (const auto& joint : active_) {
    firsts_.push_back(joints_.size());
    if (joint->isInWorld()) joint->addJoints(seconds, joints_);
  }
  return &joints_;
}

void SurfaceJointRows::finish(btScalar seconds) {
  assert(firsts_.size() <= active_.size());
  for (std::size_t k = 0; k < firsts_.size(); ++k) active_[k]->finish(seconds, joints_.data() + firsts_[k]);
  firsts_.clear();
}

void SurfaceJointRows::shift(const btVector3& by) {
  for (const auto& joint : active_) {
    if (joint->body()) joint->shift(by);
  }
}

void SurfaceJointRows::serialize(WorldStream& stream) {
  for (const auto& joint : active_) {
    if (joint->isInWorld()) joint->serialize(stream);
  }
}

void SurfaceJointRows::checkState(WorldStream& stream) {
  const auto count =
      std::count_if(active_.begin(), active_.end(), [](const auto& joint) { return joint->isInWorld(); });
  stream.same(count, "other springs or welds");
  for (const auto& joint : active_) {
    if (joint->isInWorld() && !stream.failed()) joint->checkState(stream);
  }
}

}  // namespace tetskin::touch_detail
