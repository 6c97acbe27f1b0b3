// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The deformable world: its solver, the world that owns it, and the forces that act in it.
#pragma once

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/types.h>

#include <cstddef>
#include <memory>

namespace tetskin {

class DeformableSolver;
class ForceRecord;

namespace bullet_detail {
class RecordedForces;
}

/// Wall time in seconds that the stages of a DeformableSolver's steps have taken, in the order in which a step runs
/// them. The rest of the world's `stepSimulation` is Bullet's: its solve of rigid bodies, its integration, and its own
/// contacts between soft bodies.
struct StepTimes {
  double prediction = 0;   ///< forces, and the elastic solve of each body without contacts
  double rigidSearch = 0;  ///< collision detection: contacts with rigid objects, and among these
  double softSearch = 0;   ///< search for contacts among soft bodies, and of a body with itself
  double rows = 0;         ///< collecting rows of contacts, joints and anchors, and what they connect
  double system = 0;       ///< the solve with rows, and writing its velocities

  /// Sum of all stages.
  double total() const { return prediction + rigidSearch + softSearch + rows + system; }
};

/// Bullet's solver of deformable bodies, extended by tetskin's own implicit solve. An application creates it in place
/// of a `btDeformableBodySolver`, and passes it to its world and its constraint solver in the same way.
///
/// Bodies of `ForceModel::Corotated` are solved implicitly, in steps of second order while nothing touches them: after
/// a step, `m_x` are the positions at its end, and `m_v` the velocities at its middle. They are solved before collision
/// detection, and again if there are contacts: contacts and Bullet's anchors are then rows of one system, iterated to
/// convergence. Dynamic rigid bodies and multibodies in contact are unknowns of the system, as are those that they
/// touch or are connected to, up to 2,000; their own contacts and joints start from Bullet's solution. Bullet's
/// constraints for such contacts and anchors are removed before Bullet solves. All other bodies are solved with
/// Bullet's forces, as Bullet does in an explicit world with projection of contacts. For a sleeping body, only its
/// neighbourhood is examined. `ForceModel::Corotated`, tetskin::contact and tetskin::touch need this solver; a world
/// that has any of them uses this solver's solve, whatever the settings of Bullet's. Bullet's own code solves a world
/// that has only Bullet's forces and is implicit, has line search, or has no projection (Bullet's default;
/// `setUseProjection(true)` or `DeformableBody::add` switches projection on).
///
/// Contact at nodes respects groups, masks, the world's overlap filter callback and the collision response flags of
/// both bodies, evaluated in each step. Bodies fall asleep only where they would stay, never in free flight. Sleeping
/// bodies wake when the application moves or changes them, when something that they lie on or are attached to is moved,
/// changed or removed, and when an obstacle comes near; see the guide.
///
/// A kinematic body that is moved once per frame follows a curve with a continuous velocity: each step puts it at its
/// place on this curve. Callbacks within a step see it there.
///
/// A body whose collision flags allow no contact with soft bodies (the default of `createSoftBody`) is marked as
/// sleeping between the solve and its integration, so that Bullet does not search for such contacts; only a world's
/// solver callback can observe this.
class TETSKIN_SOLVER_API DeformableSolver : public btDeformableBodySolver {
 public:
  /// A solver without bodies; the world passes its bodies in each step.
  DeformableSolver();
  ~DeformableSolver() override;
  DeformableSolver(const DeformableSolver&) = delete;
  DeformableSolver& operator=(const DeformableSolver&) = delete;

  /// Sets the threads to use; null: none. Not owned, must stay valid until replaced. Steps are bit-identical with any
  /// number of threads.
  void setThreads(ParallelFor* threads);

  /// Whether elasticity is computed in the same order of operations on every processor, without fused multiply-adds,
  /// from the next step on; off by default. Costs some percent of a step. This is tetskin's share in getting the same
  /// bits on other processors and with other compilers; docs/replay.md in the guide says what else is needed, and how
  /// far it has been measured.
  void setDeterministic(bool on);
  bool deterministic() const;  ///< see `setDeterministic`

  /// Seconds for which soft bodies, and what they lie on or carry, must be seen at rest before they fall asleep; 0.5 by
  /// default. The shorter, the less is waited for: with a heavy damping, a body may creep on by some percent of its
  /// sag. Rigid bodies whose islands have no soft body keep Bullet's own time. A snapshot restores it.
  /// seconds  at least 0; infinite: they never fall asleep
  /// Errors   InvalidOption: a number below 0, or none. Nothing is changed on an error
  Status setSleepAfter(btScalar seconds);
  btScalar sleepAfter() const;  ///< see `setSleepAfter`

  /// Whether to compute Bullet's node normals (`m_n`): needed to draw a body's own faces, not for a skin. On by
  /// default.
  void setNodeNormals(bool on);

  /// From now on every step uses this solver's own solve, whatever the world's settings of Bullet's solve (implicit,
  /// line search, projection). Called by `DeformableBody::add` with ForceModel::Corotated, and by contacts and joints.
  void requireOwnSolve();
  /// True if this solver's own solve is in use: always after `requireOwnSolve`, otherwise as the world was set in the
  /// last step; true before the first.
  bool ownSolveActive() const;
  /// Iterations of the conjugate gradient in the last step, over all bodies; 0 if Bullet's own code solved it.
  int iterations() const;

  /// Linear solves of the last step, over all bodies with other forces than elasticity; bodies that are solved
  /// simultaneously count once.
  int linearSolves() const;
  /// Number of systems in the last step that were stopped before convergence; their bodies continue with the result so
  /// far. A body without contacts is a system by itself.
  int unconvergedSystems() const;
  /// Times of all steps so far; subtract two readings to get those of the steps between.
  const StepTimes& stepTimes() const;

  // What Bullet calls.
  void reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) override;
  void predictMotion(btScalar dt) override;
  void processCollision(btSoftBody* body, const btCollisionObjectWrapper* object) override;
  using btDeformableBodySolver::processCollision;
  void setupDeformableSolve(bool implicit) override;
  void setConstraints(const btContactSolverInfo& info) override;
  void setLagrangeMultiplier() override;
  void solveDeformableConstraints(btScalar dt) override;
  void applyTransforms(btScalar dt) override;
  void updateSoftBodies() override;

 private:
  struct Impl;
  friend struct Access<DeformableSolver>;
  std::unique_ptr<Impl> impl_;
};

/// How forces act on rigid bodies in a DeformableWorld.
enum class RigidForceModel {
  PlainWorld,       ///< as in btDiscreteDynamicsWorld: once
  DeformableWorld,  ///< as in btDeformableMultiBodyDynamicsWorld: the application's forces twice, gravity once
};

/// Options of a DeformableWorld.
struct DeformableWorldOptions {
  btVector3 gravity{0, btScalar(-9.81), 0};  ///< world length / s^2
  ParallelFor* threads = nullptr;  ///< threads for the solver, not owned, see `DeformableSolver::setThreads`; or null
  bool deterministic = false;      ///< see `DeformableSolver::setDeterministic`; rigid bodies then turn so, too
  RigidForceModel rigidForces = RigidForceModel::PlainWorld;  ///< choose the other for scenes tuned in Bullet's world
  btScalar sleepAfter = btScalar(0.5);  ///< seconds, see `DeformableSolver::setSleepAfter`; 0.5 if that refuses it
  /// Into how many parts `stepSimulation` may divide steps while an elastic body hits something, 1 to 64; others count
  /// as the nearest of these. 1: never.
  int impactParts = 4;
};

/// Internal to DeformableWorld: the objects that a world needs, in a base class so that they outlive it.
class TETSKIN_SOLVER_API DeformableWorldObjects {
 protected:
  DeformableWorldObjects();
  ~DeformableWorldObjects();
  struct Impl;
  std::unique_ptr<Impl> impl_;  ///< never null
};

/// A deformable world that owns everything it needs: Bullet's collision configuration, dispatcher, broadphase and
/// constraint solver, and a `DeformableSolver`. Rigid bodies move as in Bullet's `btMultiBodyDynamicsWorld`. For
/// everything else it is a `btDeformableMultiBodyDynamicsWorld`.
///
///     tetskin::DeformableWorld world;
///     auto body = tetskin::DeformableBody::add(world, cage).value();
///     world.stepSimulation(dt, 4, dt / 4);
///
/// An application that already has these objects can keep them: it creates a `DeformableSolver` in place of its
/// `btDeformableBodySolver`, and needs no DeformableWorld.
///
/// Ownership  the world destroys its own objects, in the right order. Rigid bodies and shapes belong to the
///            application, as in any Bullet world; a `DeformableBody`, contacts, joints and force records should be
///            destroyed before the world
class TETSKIN_SOLVER_API DeformableWorld : private DeformableWorldObjects, public btDeformableMultiBodyDynamicsWorld {
 public:
  /// An empty world, with projection of contacts switched on.
  explicit DeformableWorld(const DeformableWorldOptions& options = {});
  ~DeformableWorld() override;
  DeformableWorld(const DeformableWorld&) = delete;
  DeformableWorld& operator=(const DeformableWorld&) = delete;

  DeformableSolver& deformableSolver();                       ///< solver of soft bodies; owned by this
  btDeformableMultiBodyConstraintSolver& constraintSolver();  ///< solver of rigid bodies; owned by this
  btDbvtBroadphase& broadphase();                             ///< finds pairs of overlapping boxes; owned by this
  btCollisionDispatcher& dispatcher();                        ///< Bullet's collision dispatcher; owned by this

  /// As in Bullet, but some steps are divided, into at most 64 parts. First, those in which gravity moves a soft body
  /// by more than 6 % of its size: after a hitch, or with a body of some millimetres. Second, all steps of a call in
  /// which an elastic body hits something, or may do so by its box, if its impact has less than nine of them: see
  /// `DeformableWorldOptions::impactParts`. Bodies whose damping leaves them less than a fifth of their energy, and
  /// those that flow, ask for none; links of multibodies count as standing. All of the world takes the shorter steps,
  /// so such a call costs up to that many times as much.
  ///
  /// Tick callbacks are called for each part, with its length. Joint limits that are impulses per step (hinges' motors,
  /// multibodies' joints, breaking thresholds) are divided as well. The world can be neither saved nor restored during
  /// the call. A time that is negative or not finite, or a fixedTimeStep of 0, changes nothing.
  /// Returns  the number of steps, counting each part
  int stepSimulation(btScalar timeStep, int maxSubSteps = 1,
                     btScalar fixedTimeStep = btScalar(1) / btScalar(60)) override;

  /// Called by Bullet. With a deterministic solver, rigid bodies are turned with arithmetic and square roots only.
  void predictUnconstraintMotion(btScalar dt) override;

 protected:
  /// Called by Bullet, likewise.
  void integrateTransforms(btScalar dt) override;
};

/// Makes a point the origin, for worlds that are large compared with the precision of a float. The point is subtracted
/// from all positions in the world: soft and rigid bodies, multibodies, joints to points in space, targets of springs,
/// motion states, and all remembered positions. The world continues as before.
///
/// It does not move what the world does not hold: bodies outside of it; the application's own positions, in motion
/// states that compute them, in forces and in actions; pivots in space of multibodies' joints. Broadphases other than
/// btDbvtBroadphase may find pairs anew. For skins that interpolate, call `SoftBodySkin::markTeleported`.
///
/// world   created with a `DeformableSolver`
/// origin  world space; best a whole number that a float represents, such as a multiple of 1,024
/// Cost    O(nodes + objects + contacts)
/// Errors  InvalidOption: another solver, within a step, or a position would exceed Limits::kMaxCoordinate; NonFinite.
///         Nothing is changed on an error
TETSKIN_SOLVER_API Status shiftOrigin(btDeformableMultiBodyDynamicsWorld& world, const btVector3& origin);

/// A force, and its torque about the centre of mass of the object on which it acts. For a soft body this is the centre
/// of its nodes' masses, for a rigid body or a link the origin of its frame. World space, in the world's units of mass,
/// length and seconds.
struct Wrench {
  btVector3 force{0, 0, 0};   ///< mass length / s^2
  btVector3 torque{0, 0, 0};  ///< mass length^2 / s^2
};

/// Forces on an object, by cause.
struct AppliedForces {
  Wrench contact;   ///< normal forces of contacts
  Wrench friction;  ///< friction forces, tangential to the contacts
  Wrench joints;    ///< `SurfaceSpring`, `SurfaceWeld` and `SurfacePoint::applyForce`
  Wrench anchors;   ///< Bullet's anchors, by `appendDeformableAnchor`

  /// Sum of all four.
  Wrench total() const {
    return {contact.force + friction.force + joints.force + anchors.force,
            contact.torque + friction.torque + joints.torque + anchors.torque};
  }
};

/// Records the forces between soft bodies and what they touch or are attached to: rigid bodies, links of multibodies,
/// other soft bodies. Use it to find, for instance, what a gripper feels. Covers contact at the surface
/// (`SurfaceContact`, `SoftContacts`) and at nodes.
///
///     auto forces = ForceRecord::add(world).value();
///     ...
///     world.stepSimulation(...);
///     btScalar grip = forces->forcesBetween(finger, held).friction.force.length();
///
/// Each force is the mean over all substeps of the last `stepSimulation`: multiplied by its seconds, it is the impulse
/// on either side of a pair. A contact that is shorter than a step, or ends in it, counts for as long as it lasts.
/// Forces between two sleeping bodies keep the values they had when these fell asleep. Nothing else changes the forces:
/// neither Bullet's `contactTest` nor moving bodies between steps. An object that has since left the world has no
/// forces, and exerts none on others.
///
/// It records what a `DeformableSolver` solves for: forces of bodies of `ForceModel::Corotated`. It does not record
/// forces within one body, nor those between rigid bodies, which are in Bullet's manifolds. The torque on a kinematic
/// body is about its position at the end of each step.
///
/// In the world's `debugDrawWorld`, with DBG_DrawContactPoints, it draws the loaded contact points of the last substep,
/// their normals, and their forces: a force equal to the soft body's weight is drawn as long as the body. Bullet calls
/// this only if DBG_DrawWireframe, DBG_DrawAabb or DBG_DrawNormals is set as well.
///
/// Lifetime  the record, bodies, and the world may be destroyed in any order
/// Cost      per substep O(contact points, and nodes of bodies in contact); none in a world without a record. Several
///           records of one world share their data
class TETSKIN_SOLVER_API ForceRecord {
 public:
  /// Starts recording with the next step, until the record is destroyed.
  /// world   created with a `DeformableSolver`
  /// Errors  InvalidOption for worlds with another solver
  static Result<std::unique_ptr<ForceRecord>> add(btDeformableMultiBodyDynamicsWorld& world);
  ~ForceRecord();
  ForceRecord(const ForceRecord&) = delete;
  ForceRecord& operator=(const ForceRecord&) = delete;

  /// Forces on an object. On a rigid body or a link (its collider): from all soft bodies. On a soft body: from
  /// everything that it touches or is attached to, including points in space. All 0 if nothing acts, or if the object
  /// is not in the world.
  /// Cost  O(pairs in contact, and objects of the world for each of this object's); allocates nothing
  AppliedForces forcesOn(const btCollisionObject& object) const;
  /// Forces on the first object from the second alone; one of the two must be a soft body. All 0 if nothing acts.
  /// Cost  O(pairs in contact, and objects of the world for each of the first object's); allocates nothing
  AppliedForces forcesBetween(const btCollisionObject& object, const btCollisionObject& other) const;

 private:
  explicit ForceRecord(std::shared_ptr<bullet_detail::RecordedForces> recorded);
  std::shared_ptr<bullet_detail::RecordedForces> recorded_;
};

}  // namespace tetskin
