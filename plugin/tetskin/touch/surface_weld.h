// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/touch/surface_point.h>

class btDiscreteDynamicsWorld;
class btMultiBodyLinkCollider;

namespace tetskin {

/// Fixes a rigid body, or a link of a multibody, to a point of a surface, as they are to each other now: a sword that
/// sticks. Place and turn are kept both ways; the surface around goes on to deform. For the rest, as `SurfaceSpring`.
class TETSKIN_TOUCH_API SurfaceWeld {
 public:
  /// collide  whether the body and what is fixed to it may touch each other
  /// Errors   those of `SurfaceSpring::add`
  static Result<std::unique_ptr<SurfaceWeld>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                  btRigidBody& rigid, bool collide = false);
  /// The same.
  static Result<std::unique_ptr<SurfaceWeld>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                  btMultiBodyLinkCollider& link, bool collide = false);
  ~SurfaceWeld();
  SurfaceWeld(const SurfaceWeld&) = delete;
  SurfaceWeld& operator=(const SurfaceWeld&) = delete;

  /// As `SurfaceSpring::status`.
  TouchStatus status() const;
  /// Of the last step, on the body, world space.
  btVector3 force() const;
  /// Likewise, about the point.
  btVector3 torque() const;
  /// How far apart they are, world units; 0 unless the status is Ok.
  btScalar separation() const;
  /// By which angle they have turned to each other, in radians; likewise.
  btScalar turn() const;

  /// Lets go, for good.
  void release();

 private:
  struct Parts;
  explicit SurfaceWeld(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
