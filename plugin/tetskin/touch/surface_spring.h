// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/touch/surface_point.h>

#include <memory>

class btDiscreteDynamicsWorld;
class btMultiBodyLinkCollider;

namespace tetskin {

/// How a spring pulls.
struct SurfaceSpringOptions {
  /// Over the mass of a point, in units of 1 / (1/240 s)^2: so the same spring in steps of any length. The mass is that
  /// of a tet's four nodes, as they are on the mean: no less at tips of light nodes, on which the body hangs as
  /// heavily. 0: 10 to a point in space, 1,000 to a body. Stable at any value.
  double stiffness = 0.0;
  /// Over the critical damping of that mass, against the target; 0 leaves what an implicit step damps anyway.
  double damping = 0.0;
  /// Most of the force, to some hundredths in each step. 0: to a point in space the body's mass times the larger of 4
  /// times the world's gravity and 20 of the body's sizes per second squared, so that a target that jumps neither tears
  /// the body nor throws it: set more where it carries more than itself. To a body unbounded, as is infinity.
  double maxForce = 0.0;
  /// Whether the body and what it is tied to may touch each other.
  bool collide = false;
};

/// Pulls a point of a surface to a point in space, which the application moves, or to one of a rigid body or a link of
/// a multibody, which feels it: a ball joint. In a deformable world with a `DeformableSolver`, which solves for it with
/// the body, and with the other's mass, at once.
///
///     auto spring = tetskin::SurfaceSpring::add(*world, point).value();   // picked
///     spring->setTarget(mouse);                                           // dragged; let go by deleting it
///
/// Deformable bodies of one world share one object in its list of forces. Delete springs before
/// what they are tied to, and before the world. When the body goes first, they only say so; an application's own body
/// must be released before.
class TETSKIN_TOUCH_API SurfaceSpring {
 public:
  using Options = SurfaceSpringOptions;  ///< how it pulls

  /// To where the point is now.
  /// world   deformable, made with a `DeformableSolver`
  /// Errors  InvalidOption for options out of range, for other worlds, and for points that are not Ok
  static Result<std::unique_ptr<SurfaceSpring>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                    const Options& options = {});
  /// To a point of a rigid body, or of a link.
  /// pivot  in its own space
  static Result<std::unique_ptr<SurfaceSpring>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                    btRigidBody& rigid, const btVector3& pivot,
                                                    const Options& options = {});
  /// The same.
  static Result<std::unique_ptr<SurfaceSpring>> add(btDiscreteDynamicsWorld& world, const SurfacePoint& point,
                                                    btMultiBodyLinkCollider& link, const btVector3& pivot,
                                                    const Options& options = {});
  ~SurfaceSpring();
  SurfaceSpring(const SurfaceSpring&) = delete;
  SurfaceSpring& operator=(const SurfaceSpring&) = delete;

  /// From the next step on. A body that sleeps wakes, if the target has moved. Of a spring to a body, the pivot.
  /// Errors  those of `status`; NonFinite
  TouchStatus setTarget(const btVector3& target);
  /// As in the options. Errors: InvalidOption, and nothing is changed
  TouchStatus setStiffness(double stiffness);
  /// Likewise.
  TouchStatus setMaxForce(double force);

  /// That of the point; OutOfWorld once the body was taken out of the world, for good.
  TouchStatus status() const;
  /// Of the last step, on the body, world space.
  btVector3 force() const;
  /// Between point and target, as they are now; 0 unless the status is Ok.
  btScalar stretch() const;

  /// Lets go, for good.
  void release();

 private:
  struct Parts;
  explicit SurfaceSpring(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
