// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/joints/joint_owner.h>
#include <tetskin/touch/surface_joint.h>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace tetskin {

using namespace bullet_detail;

namespace {

using touch_detail::Joint;
using touch_detail::JointAnchor;
using touch_detail::JointOwner;
using touch_detail::JointSettings;

/// The anchor at the point's current position.
JointAnchor anchorIn(btCollisionObject& object, const SurfacePoint& point) {
  return {&object, btTransform(btMatrix3x3::getIdentity(), object.getWorldTransform().invXform(*point.position()))};
}

}  // namespace

struct SurfaceWeld::Impl {
  Impl(const SurfacePoint& point, const JointAnchor& anchor, const JointSettings& settings)
      : owner(std::make_shared<Joint>(point, anchor, settings)) {}

  static Result<std::unique_ptr<SurfaceWeld>> make(const SurfacePoint& point, const JointAnchor& anchor, bool collide) {
    JointSettings settings;
    settings.turns = true;
    settings.collide = collide;
    return std::unique_ptr<SurfaceWeld>(new SurfaceWeld(std::make_unique<Impl>(point, anchor, settings)));
  }

  JointOwner owner;
};

SurfaceWeld::SurfaceWeld(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceWeld::~SurfaceWeld() = default;

Result<std::unique_ptr<SurfaceWeld>> SurfaceWeld::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                      btRigidBody& rigid, bool collide) {
  if (Status status = JointOwner::check(world, point); !status.ok()) return status;
  return Impl::make(point, anchorIn(rigid, point), collide);
}

Result<std::unique_ptr<SurfaceWeld>> SurfaceWeld::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                      btMultiBodyLinkCollider& link, bool collide) {
  if (Status status = JointOwner::check(world, point); !status.ok()) return status;
  return Impl::make(point, anchorIn(link, point), collide);
}

StatusCode SurfaceWeld::status() const {
  return impl_->owner.status();
}
btVector3 SurfaceWeld::force() const {
  return impl_->owner.joint().force();
}
btVector3 SurfaceWeld::torque() const {
  return impl_->owner.joint().torque();
}
btScalar SurfaceWeld::separation() const {
  if (status() != StatusCode::Ok) return 0;
  return impl_->owner.joint().offset().length();
}
btScalar SurfaceWeld::angle() const {
  if (status() != StatusCode::Ok) return 0;
  return impl_->owner.joint().turn();
}
void SurfaceWeld::release() {
  impl_->owner.release();
}

}  // namespace tetskin
