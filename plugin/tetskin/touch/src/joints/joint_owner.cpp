// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/touch/src/joints/joint_owner.h>

#include <cassert>

namespace tetskin::touch_detail {

using namespace bullet_detail;

Status JointOwner::check(const btDiscreteDynamicsWorld& world, const SurfacePoint& point) {
  if (const StatusCode status = point.status(); status != StatusCode::Ok) {
    return {StatusCode::InvalidOption, std::string("invalid surface point: ") + toString(status)};
  }
  if (world.getWorldType() != BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD) {
    return {StatusCode::InvalidOption,
            "springs and welds need a deformable world created with a DeformableSolver; in other worlds, use impulses "
            "or Bullet's own anchors"};
  }
  const auto& inWorld = static_cast<const btDeformableMultiBodyDynamicsWorld&>(world).getSoftBodyArray();
  if (inWorld.findLinearSearch(point.body()) == inWorld.size()) {
    return {StatusCode::InvalidOption, "the body of the point is not in this world; add it first"};
  }
  if (deformableSolverOf(*point.body())) return {};
  return refusal("springs and welds", {kUseDeformableSolver});
}

JointOwner::JointOwner(std::shared_ptr<Joint> joint)
    : joint_(std::move(joint)), force_(SurfaceJointRows::instanceOf(*deformableSolverOf(*joint_->point().body()))) {
  assert(joint_->body());
  force_->add(joint_);
  joint_->point().body()->activate();
  if (btCollisionObject* other = joint_->anchor().object) other->activate();
}

StatusCode JointOwner::status() const {
  if (released_) return StatusCode::Released;
  const StatusCode status = joint_->point().status();
  return status == StatusCode::Ok && !joint_->isInWorld() ? StatusCode::NotInWorld : status;
}

void JointOwner::release() {
  if (!released_ && joint_->isInWorld()) joint_->body()->activate();  // what it has held falls
  released_ = true;
  force_->remove(*joint_);
  joint_->drop();
}

}  // namespace tetskin::touch_detail
