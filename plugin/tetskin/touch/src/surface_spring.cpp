// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/joints/joint_owner.h>
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/surface_joint.h>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetskin {

using namespace bullet_detail;

namespace {

using touch_detail::Joint;
using touch_detail::JointAnchor;
using touch_detail::JointOwner;
using touch_detail::JointSettings;

/// Default stiffness of a spring to a point in space, as yielding as a hand, and of one to a body.
constexpr double kToPoint = 10.0, kToBody = 1000.0;

bool isStiffness(double s) {
  return s > 0.0 && std::isfinite(s);
}

Status checkSpring(const SurfaceSpringOptions& options) {
  if (options.stiffness && !isStiffness(*options.stiffness)) {
    return {StatusCode::InvalidOption, "the stiffness of a spring must be finite and above 0"};
  }
  if (!(options.dampingRatio >= 0.0) || !std::isfinite(options.dampingRatio)) {
    return {StatusCode::InvalidOption, "the damping of a spring must be finite and not negative"};
  }
  if (options.maxForce && !(*options.maxForce > 0.0)) {
    return {StatusCode::InvalidOption, "the maximum force of a spring must be above 0"};
  }
  return {};
}

Status badPivot() {
  return {StatusCode::NonFinite, "the pivot of a spring is not finite"};
}

/// The default largest force for a point in space: it carries the body, and accelerates it as fast as a hand would.
double defaultForce(const btDiscreteDynamicsWorld& world, const btSoftBody& body) {
  // In weights of the body; and in body lengths per second squared, for low gravity.
  constexpr double kWeights = 4.0, kSizes = 20.0;
  double mass = 0.0;
  Box3 box;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    if (node.m_im > 0) mass += 1.0 / static_cast<double>(node.m_im);
    box.extend(toEigen(node.m_x));
  }
  const double gravity = static_cast<double>(world.getGravity().length());
  const double force = mass * std::max(kWeights * gravity, kSizes * box.sizes().maxCoeff());
  return force > 0.0 ? force : std::numeric_limits<double>::infinity();
}

JointSettings settingsOf(const btDiscreteDynamicsWorld& world, const SurfacePoint& point, const JointAnchor& anchor,
                         const SurfaceSpringOptions& options) {
  JointSettings settings;
  const double stiffness = anchor.object ? kToBody : kToPoint;
  settings.stiffness = options.stiffness.value_or(stiffness);
  settings.damping = options.dampingRatio;
  if (options.maxForce) {
    settings.maxForce = *options.maxForce;
  } else if (!anchor.object) {
    settings.maxForce = defaultForce(world, *point.body());
  }
  settings.collide = options.collideConnected;
  return settings;
}

btTransform at(const btVector3& pivot) {
  return btTransform(btMatrix3x3::getIdentity(), pivot);
}

}  // namespace

struct SurfaceSpring::Impl {
  Impl(const SurfacePoint& point, const JointAnchor& anchor, const JointSettings& settings)
      : owner(std::make_shared<Joint>(point, anchor, settings)) {}

  static Result<std::unique_ptr<SurfaceSpring>> make(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                     const JointAnchor& anchor, const Options& options) {
    const JointSettings settings = settingsOf(world, point, anchor, options);
    auto impl = std::make_unique<Impl>(point, anchor, settings);
    return std::unique_ptr<SurfaceSpring>(new SurfaceSpring(std::move(impl)));
  }
  static Status check(const btDiscreteDynamicsWorld& world, const SurfacePoint& point, const Options& options) {
    if (Status status = checkSpring(options); !status.ok()) return status;
    return JointOwner::check(world, point);
  }

  JointOwner owner;
};

SurfaceSpring::SurfaceSpring(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceSpring::~SurfaceSpring() = default;

Result<std::unique_ptr<SurfaceSpring>> SurfaceSpring::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                          const Options& options) {
  if (Status status = Impl::check(world, point, options); !status.ok()) return status;
  return Impl::make(world, point, {nullptr, at(*point.position())}, options);
}

Result<std::unique_ptr<SurfaceSpring>> SurfaceSpring::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                          btRigidBody& rigid, const btVector3& pivot,
                                                          const Options& options) {
  if (Status status = Impl::check(world, point, options); !status.ok()) return status;
  if (!touch_detail::isFiniteVector(pivot)) return badPivot();
  return Impl::make(world, point, {&rigid, at(pivot)}, options);
}

Result<std::unique_ptr<SurfaceSpring>> SurfaceSpring::add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                          btMultiBodyLinkCollider& link, const btVector3& pivot,
                                                          const Options& options) {
  if (Status status = Impl::check(world, point, options); !status.ok()) return status;
  if (!touch_detail::isFiniteVector(pivot)) return badPivot();
  return Impl::make(world, point, {&link, at(pivot)}, options);
}

StatusCode SurfaceSpring::setTarget(const btVector3& target) {
  if (const StatusCode now = status(); now != StatusCode::Ok) return now;
  if (!touch_detail::isFiniteVector(target)) return StatusCode::NonFinite;
  Joint& joint = impl_->owner.joint();
  btVector3& pivot = joint.anchor().frame.getOrigin();
  if (target != pivot) joint.body()->activate();
  pivot = target;
  return StatusCode::Ok;
}

StatusCode SurfaceSpring::setStiffness(double stiffness) {
  if (const StatusCode now = status(); now != StatusCode::Ok) return now;
  if (!isStiffness(stiffness)) return StatusCode::InvalidOption;
  impl_->owner.joint().settings().stiffness = stiffness;
  impl_->owner.joint().body()->activate();
  return StatusCode::Ok;
}

StatusCode SurfaceSpring::setMaxForce(double force) {
  if (const StatusCode now = status(); now != StatusCode::Ok) return now;
  if (!(force > 0.0)) return StatusCode::InvalidOption;
  impl_->owner.joint().settings().maxForce = force;
  impl_->owner.joint().body()->activate();
  return StatusCode::Ok;
}

StatusCode SurfaceSpring::status() const {
  return impl_->owner.status();
}

btVector3 SurfaceSpring::force() const {
  return impl_->owner.joint().force();
}

btScalar SurfaceSpring::stretch() const {
  if (status() != StatusCode::Ok) return 0;
  return impl_->owner.joint().offset().length();
}

void SurfaceSpring::release() {
  impl_->owner.release();
}

}  // namespace tetskin
