// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/joints/joint_owner.h>
#include <tetskin/touch/surface_weld.h>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <cmath>

namespace tetskin {
namespace {

using touch_detail::Joint;
using touch_detail::JointOwner;
using touch_detail::JointSettings;
using touch_detail::Partner;

/// Where the point is, in the object's own space.
btTransform anchorIn(const btTransform& object, const SurfacePoint& point) {
  return btTransform(btMatrix3x3::getIdentity(), object.invXform(*point.position()));
}

}  // namespace

struct SurfaceWeld::Parts {
  Parts(const SurfacePoint& point, std::unique_ptr<Partner> partner, const JointSettings& settings)
      : owner(std::make_shared<Joint>(point, std::move(partner), settings)) {}

  static Result<std::unique_ptr<SurfaceWeld>> make(const SurfacePoint& point, std::unique_ptr<Partner> partner,
                                                   bool collide) {
    JointSettings settings;
    settings.turns = true;
    settings.collide = collide;
    return std::unique_ptr<SurfaceWeld>(new SurfaceWeld(std::make_unique<Parts>(point, std::move(partner), settings)));
  }

  JointOwner owner;
};

SurfaceWeld::SurfaceWeld(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
SurfaceWeld::~SurfaceWeld() = default;

Result<std::unique_ptr<SurfaceWeld>> SurfaceWeld::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                      btRigidBody& rigid, bool collide) {
  if (Status status = JointOwner::check(world, point); !status.ok()) return status;
  return Parts::make(point, touch_detail::rigidPartner(rigid, anchorIn(rigid.getWorldTransform(), point)), collide);
}

Result<std::unique_ptr<SurfaceWeld>> SurfaceWeld::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                      btMultiBodyLinkCollider& link, bool collide) {
  if (Status status = JointOwner::check(world, point); !status.ok()) return status;
  return Parts::make(point, touch_detail::linkPartner(link, anchorIn(link.getWorldTransform(), point)), collide);
}

TouchStatus SurfaceWeld::status() const {
  return parts_->owner.status();
}
btVector3 SurfaceWeld::force() const {
  return parts_->owner.joint().force();
}
btVector3 SurfaceWeld::torque() const {
  return parts_->owner.joint().torque();
}
btScalar SurfaceWeld::separation() const {
  if (status() != TouchStatus::Ok) return 0;
  return parts_->owner.joint().offset().length();
}
btScalar SurfaceWeld::turn() const {
  if (status() != TouchStatus::Ok) return 0;
  return parts_->owner.joint().turn();
}
void SurfaceWeld::release() {
  parts_->owner.release();
}

}  // namespace tetskin
