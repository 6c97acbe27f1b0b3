// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Joints at a point of a surface: springs and welds.
#pragma once

#include <tetskin/touch/surface_point.h>

#include <memory>
#include <optional>

class btDiscreteDynamicsWorld;
class btMultiBodyLinkCollider;

namespace tetskin {

/// Options of a spring.
struct SurfaceSpringOptions {
  /// Stiffness divided by a point's mass, in units of 1 / (1/240 s)^2, so that a spring is the same in steps of any
  /// length. The mass is that of a tet's four nodes, averaged over the body: so it is not smaller at tips, whose nodes
  /// are light but may still have to carry the whole body. Above 0; not given: 10 to a point in space, 1,000 to a body.
  /// Stable at any value.
  std::optional<double> stiffness;
  /// Damping of the motion relative to the target, as a fraction of the critical damping of that mass; 0 or more. With
  /// 0, only the numerical damping of the implicit step remains.
  double dampingRatio = 0.0;
  /// Largest force, above 0 (infinity: unbounded); kept within some hundredths in each step. Not given: to a point in
  /// space, the body's mass times the larger of 4 times the world's gravity and 20 body sizes per second squared, so
  /// that a target that jumps neither tears the body nor throws it; set more if the body carries more than itself. To a
  /// body: unbounded.
  std::optional<double> maxForce;
  /// Whether the body and what it is attached to may collide with each other.
  bool collideConnected = false;
};

/// Pulls a surface point to a point in space, which the application moves, or to a point of a rigid body or a link of a
/// multibody, which feels the reaction: a ball joint. Needs a deformable world with a `DeformableSolver`, which solves
/// for the spring, the soft body and the other body's mass simultaneously.
///
///     auto spring = tetskin::SurfaceSpring::add(*world, point).value();   // picked
///     spring->setTarget(mouse);                                           // dragged; released by deleting it
///
/// All springs of one world share one object in its list of forces. Delete springs before what they are attached to,
/// and before the world. If the soft body is deleted first, the spring's status says so; for an application's own body,
/// call `release` before deleting it.
class TETSKIN_TOUCH_API SurfaceSpring {
 public:
  using Options = SurfaceSpringOptions;  ///< options of a spring

  /// Attaches a surface point to its current position in space.
  /// world   deformable, created with a `DeformableSolver`
  /// Errors  InvalidOption for options out of range, for other worlds, and for points whose status is not Ok
  static Result<std::unique_ptr<SurfaceSpring>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                    const Options& options = {});
  /// Attaches a surface point to a point of a rigid body.
  /// pivot   in the rigid body's local space
  /// Errors  those of the overload without a body; NonFinite for the pivot
  static Result<std::unique_ptr<SurfaceSpring>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                    btRigidBody& rigid, const btVector3& pivot,
                                                    const Options& options = {});
  /// Attaches a surface point to a point of a link of a multibody; `pivot` in the link's local space. Errors: those of
  /// the overload for a rigid body.
  static Result<std::unique_ptr<SurfaceSpring>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                    btMultiBodyLinkCollider& link, const btVector3& pivot,
                                                    const Options& options = {});
  ~SurfaceSpring();
  SurfaceSpring(const SurfaceSpring&) = delete;
  SurfaceSpring& operator=(const SurfaceSpring&) = delete;

  /// Sets the target, from the next step on: in world space or, for a spring to a body, the pivot in that body's local
  /// space. A sleeping body wakes if the target has moved.
  /// Errors  those of `status`; NonFinite
  StatusCode setTarget(const btVector3& target);
  /// Sets the stiffness, in the units of `SurfaceSpringOptions::stiffness`; the body wakes. Errors: those of `status`;
  /// InvalidOption if it is not finite and above 0. Nothing is changed on an error.
  StatusCode setStiffness(double stiffness);
  /// Sets the largest force, mass times length / s^2, above 0; the body wakes. Errors: those of `status`;
  /// InvalidOption. Nothing is changed on an error.
  StatusCode setMaxForce(double force);

  /// Status of the surface point, see `SurfacePoint::status`; NotInWorld while the body is out of its world, see
  /// `DeformableBody::removeFromWorld`.
  StatusCode status() const;
  /// Force on the soft body in the last step in which it was awake, world space.
  btVector3 force() const;
  /// Current distance between point and target, world length; 0 unless the status is Ok.
  btScalar stretch() const;

  /// Releases the point permanently: the status is Released from now on.
  void release();

 private:
  struct Impl;
  explicit SurfaceSpring(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Fixes a rigid body, or a link of a multibody, to a surface point in their current relative placement, for instance a
/// sword stuck in a body. Constrains position and rotation, and acts on both; the surface around it continues to
/// deform. The rules of `SurfaceSpring` for solver, lifetime and deletion apply.
class TETSKIN_TOUCH_API SurfaceWeld {
 public:
  /// Attaches a rigid body.
  /// collide  whether the soft body and the attached object may collide with each other
  /// Errors   those of `SurfaceSpring::add`
  static Result<std::unique_ptr<SurfaceWeld>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                  btRigidBody& rigid, bool collide = false);
  /// Attaches a link of a multibody; parameters and errors as for a rigid body.
  static Result<std::unique_ptr<SurfaceWeld>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                  btMultiBodyLinkCollider& link, bool collide = false);
  ~SurfaceWeld();
  SurfaceWeld(const SurfaceWeld&) = delete;
  SurfaceWeld& operator=(const SurfaceWeld&) = delete;

  /// Status of the surface point, see `SurfacePoint::status`; NotInWorld while the body is out of its world, see
  /// `DeformableBody::removeFromWorld`.
  StatusCode status() const;
  /// Force on the soft body in the last step in which it was awake, world space.
  btVector3 force() const;
  /// Torque on the soft body in that step, about the point, world space.
  btVector3 torque() const;
  /// Current positional error of the weld, world length; 0 unless the status is Ok.
  btScalar separation() const;
  /// Current rotational error of the weld, radians; 0 unless the status is Ok.
  btScalar angle() const;

  /// Releases the rigid body permanently: the status is Released from now on.
  void release();

 private:
  struct Impl;
  explicit SurfaceWeld(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
