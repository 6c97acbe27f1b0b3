// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: what a joint ties a point of a surface to.
#pragma once

#include <LinearMath/btTransform.h>

#include <Eigen/Core>
#include <memory>

class btCollisionObject;
class btMultiBodyLinkCollider;
class btRigidBody;

namespace tetskin::touch_detail {

/// Three numbers along, three about.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Where the joint holds it is its *anchor*.
class Partner {
 public:
  virtual ~Partner() = default;
  /// Null for a point in space.
  virtual btCollisionObject* object() const { return nullptr; }
  /// What it has its mass from, as others may.
  virtual const void* mass() const { return object(); }
  virtual btTransform anchor() const = 0;
  virtual void moveAnchor(const btVector3& local) = 0;

  /// Now, at any time.
  virtual double speed() const { return 0; }
  /// Reads it as it is before the solve of a step, for all that follows.
  virtual void begin() {}
  /// How fast the anchor will move and turn without the joint; nothing for what Bullet does not move in this step.
  virtual Vector6 velocity() const { return Vector6::Zero(); }
  /// By how much faster for a unit impulse and moment at the anchor.
  virtual Matrix6 response() const { return Matrix6::Zero(); }
  /// An impulse and a moment at the anchor, through the step of dt seconds that has just moved it; it may be one of
  /// several that share its mass.
  virtual void apply(const Vector6& /*push*/, double /*dt*/, int /*sharers*/) {}
};

std::unique_ptr<Partner> pointInSpace(const btVector3& at);
/// anchor  in the body's own space; it turns with the body
std::unique_ptr<Partner> rigidPartner(btRigidBody& body, const btTransform& anchor);
std::unique_ptr<Partner> linkPartner(btMultiBodyLinkCollider& link, const btTransform& anchor);

}  // namespace tetskin::touch_detail
