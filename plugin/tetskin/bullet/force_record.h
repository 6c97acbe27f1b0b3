// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>

#include <memory>

namespace tetskin {

class RecordedForces;

/// A force, and its torque about the centre of mass of what it acts on: of nodes' masses, of a rigid body or a link
/// where its frame is. World space, in the world's units of mass, length and seconds.
struct Wrench {
  btVector3 force{0, 0, 0};   ///< mass length / s^2
  btVector3 torque{0, 0, 0};  ///< mass length^2 / s^2
};

/// What acts on an object, by what it comes from.
struct AppliedForces {
  Wrench contact;   ///< along the normals of what touches
  Wrench friction;  ///< along the surfaces there
  Wrench joints;    ///< `SurfaceSpring`, `SurfaceWeld` and `SurfacePoint::applyForce`
  Wrench anchors;   ///< Bullet's, of `appendDeformableAnchor`

  /// Their sum.
  Wrench total() const {
    return {contact.force + friction.force + joints.force + anchors.force,
            contact.torque + friction.torque + joints.torque + anchors.torque};
  }
};

/// The forces between soft bodies and what they touch or hang on: rigid bodies, links of multibodies, other soft
/// bodies; what a gripper feels. By surface (`SurfaceContact`, `SoftContacts`) and by nodes alike.
///
///     auto forces = ForceRecord::add(world).value();
///     ...
///     world.stepSimulation(...);
///     btScalar grip = forces->on(finger, held).friction.force.length();
///
/// Each is the mean over all substeps of the last `stepSimulation`, so that impulses on both sides of a pair are that
/// mean times its seconds; what takes less time than a step, or ends in it, counts for as long as it lasts. What two
/// bodies asleep do to each other stays as it was when they fell asleep. Nothing else changes it: neither Bullet's
/// `contactTest` nor bodies that are moved between steps. An object that has left the world since has no forces, nor
/// does it act on others.
///
/// Recorded is what a `DeformableSolver` solves for: of bodies of `ForceModel::Corotated`. Not of a body with itself,
/// and not of rigid bodies among themselves, which Bullet's manifolds tell of. Torque on a kinematic body is about
/// where Bullet has it in a step, which is where the whole `stepSimulation` takes it.
///
/// In the world's `debugDrawWorld`, with DBG_DrawContactPoints, it draws the points that are pushed in the last
/// substep, their normals, and the forces there: one as large as the soft body's weight is drawn as long as the body.
/// Bullet asks for that only with DBG_DrawWireframe, DBG_DrawAabb or DBG_DrawNormals beside.
///
/// Lifetime  it goes before its world; bodies may go in any order
/// Cost      in a substep O(points that touch, and nodes of bodies that do); in a world without it nothing. Several of
///           one world share one record
class TETSKIN_BULLET_API ForceRecord {
 public:
  /// From the next step on, until it is deleted.
  /// world   made with a `DeformableSolver`
  /// Errors  InvalidOption for worlds with another solver
  static Result<std::unique_ptr<ForceRecord>> add(btDeformableMultiBodyDynamicsWorld& world);
  ~ForceRecord();
  ForceRecord(const ForceRecord&) = delete;
  ForceRecord& operator=(const ForceRecord&) = delete;

  /// On a rigid body or a link (its collider): of all soft bodies. On a soft body: of all that it meets and hangs on,
  /// points in space, too. All 0 where nothing acts, or the object is not in the world.
  /// Cost  O(pairs that touch, and objects of the world for each of this object's); allocates nothing
  AppliedForces on(const btCollisionObject& object) const;
  /// Of another object alone; one of the two is a soft body.
  AppliedForces on(const btCollisionObject& object, const btCollisionObject& other) const;

 private:
  explicit ForceRecord(std::shared_ptr<RecordedForces> recorded);
  std::shared_ptr<RecordedForces> recorded_;
};

}  // namespace tetskin
