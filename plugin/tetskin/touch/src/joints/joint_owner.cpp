// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/shared/solver/required_solver.h>
#include <tetskin/touch/src/joints/joint_owner.h>

namespace tetskin::touch_detail {

Status JointOwner::check(const btDiscreteDynamicsWorld& world, const SurfacePoint& point) {
  if (const TouchStatus status = point.status(); status != TouchStatus::Ok) {
    return {StatusCode::InvalidOption, std::string("the point of the surface is no good: ") + toString(status)};
  }
  const auto* deformable = dynamic_cast<const btDeformableMultiBodyDynamicsWorld*>(&world);
  if (!deformable) {
    return {
        StatusCode::InvalidOption,
        "springs and welds need a deformable world, made with a DeformableSolver; in the classic ones, use impulses, "
        "or Bullet's own anchors"};
  }
  const auto& inWorld = deformable->getSoftBodyArray();
  if (inWorld.findLinearSearch(point.body()) == inWorld.size()) {
    return {StatusCode::InvalidOption, "the point's body is not in this world: add it there first"};
  }
  if (deformableSolverOf(*point.body())) return {};
  return refusal("springs and welds", {kUseDeformableSolver});
}

JointOwner::JointOwner(std::shared_ptr<Joint> joint)
    : joint_(std::move(joint)), force_(TouchForce::of(*deformableSolverOf(*joint_->point().body()))) {
  force_->add(joint_);
  joint_->point().body()->activate();
  if (btCollisionObject* other = joint_->anchor().object) other->activate();
}

TouchStatus JointOwner::status() const {
  if (released_) return TouchStatus::Released;
  const TouchStatus of = joint_->point().status();
  return of == TouchStatus::Ok && joint_->dropped() ? TouchStatus::OutOfWorld : of;
}

void JointOwner::release() {
  released_ = true;
  const btSoftBody* body = joint_->body();
  if (body && body->getBroadphaseHandle()) force_->remove(*joint_);
  joint_->drop();
}

}  // namespace tetskin::touch_detail
