// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>

#include <memory>

namespace tetskin {

/// Which code computes and solves a body's elastic forces.
enum class SolverPath {
  Bullet,  ///< Bullet's own force
  Solver,  ///< ForceModel::Corotated, solved by a DeformableSolver
  None,    ///< no force: the body has been removed from its world, or has tets that cannot be simulated any more
};

/// A soft body in a deformable world, with its own gravity and elastic forces: creates, separates and deletes the
/// objects that Bullet leaves to the application.
///
/// Bullet's `addForce` gives a second body the force of the first one of the same type, including its material, and
/// neither bodies nor forces are ever deleted. A DeformableBody has its own forces, which no other body joins, and
/// deletes all of them in its destructor. Destroy it before the world. If the world has been deleted first, this object
/// only frees its memory; but a solver that outlives its world must then not be used in another one.
///
/// The application may remove the body from the world itself: it then has no forces until `addToWorld`. If it has added
/// the body to another world, the application owns the body: it stays there when this object is destroyed, and is not
/// deleted.
class TETSKIN_SOLVER_API DeformableBody {
 public:
  /// Creates the body (see `createSoftBody`) and adds it to the world. Unless `options.configureWorld` is false,
  /// switches on the world's projection of contacts, without which soft bodies do not land but hang or fall through,
  /// and applies `options.implicit`, if it is given; nothing else in the world is changed. Step the world with
  /// `stepSimulation(dt, 4, dt / 4)` at 60 frames per second; one substep per frame is too few.
  ///
  /// world   created with a `DeformableSolver`; for Bullet's own forces a btDeformableBodySolver works, too. Its
  ///         gravity at the time of the call sets the scale of the default stiffness
  /// cage    at the body's initial position, world space; its volume fractions, stiffness factors and masses are used
  ///         where the options give none. Its quadratic tets are simulated as such by ForceModel::Corotated, while the
  ///         btSoftBody has the eight linear tets of each, as Bullet's own force models do; they become linear if the
  ///         application changes the body's tets, or their rest shapes to others than those of a tet with straight
  ///         edges
  /// Errors  those of `createSoftBody`; InvalidOption for ForceModel::MassSpring, which has no stable setting here, for
  ///         ForceModel::Corotated in a world without a `DeformableSolver`, or with `options.implicit`, and for the
  ///         worlds of reduced bodies
  static Result<std::unique_ptr<DeformableBody>> add(btDeformableMultiBodyDynamicsWorld& world, const Cage& cage,
                                                     const SoftBodyOptions& options = {});
  ~DeformableBody();
  DeformableBody(const DeformableBody&) = delete;
  DeformableBody& operator=(const DeformableBody&) = delete;

  /// Takes the body out of its world, in which it costs nothing any more, until `addToWorld`. Its nodes, velocities,
  /// material, gravity, pins and collision filters stay. So do skins, its SurfaceContact, its place in SoftContacts,
  /// and its springs and welds, whose status is NotInWorld meanwhile. Forces of `SurfacePoint::applyForce` end. What
  /// lies beside the body wakes. While it is out, a snapshot that was saved with it is refused: SnapshotMismatch.
  /// Nothing happens to a body that is not in its world. May be called where bodies may be removed.
  void removeFromWorld();
  /// Puts it back, into the world that it was in or another one, where it continues; it wakes. Its skins and its
  /// SurfaceContact go along into another world; SoftContacts, springs and welds stay with the world in which they were
  /// created, and act again when the body is back there. Also for a body that the application has taken out by Bullet's
  /// own call, which keeps no filters, and may have added again.
  /// world   created with a solver as for `add`. The body follows its gravity, unless it has one of its own
  /// Errors  InvalidOption: the body is in a world; the world has another solver, or a gravity too large for the body.
  ///         On an error nothing is changed
  Status addToWorld(btDeformableMultiBodyDynamicsWorld& world);

  btSoftBody& body();              ///< Bullet's body, owned by this object
  const btSoftBody& body() const;  ///< Bullet's body, owned by this object

  ForceModel forceModel() const;  ///< the elastic model, from the options
  /// Which code solves for the body: given by its force model while it is in its world.
  SolverPath solverPath() const;

  /// Young's modulus in use, in pressure units: the last one set, or that of the options, or the default for this cage,
  /// the world's gravity and `options.timeStep`.
  double youngsModulus() const;
  /// Young's modulus over density x gravity x size (the world's gravity when the body was added), dimensionless: from
  /// 30 (wobbles, sags) to 300 (firm). Below some 5 a body cannot support itself: its own weight flattens it.
  double relativeStiffness() const;
  double poissonRatio() const;      ///< Poisson's ratio in use, 0 to below 0.5
  double stiffnessDamping() const;  ///< stiffness-proportional (Rayleigh) damping in use, seconds

  /// Sets Young's modulus, in pressure units, above 0, from the next step on; not limited by the time step. The body
  /// wakes. Error: InvalidOption, also for a body that is too stiff for its mass and size (E above 1e12 density size^2
  /// / s^2 in float, 1e16 in double); nothing is changed then.
  Status setYoungsModulus(double pressure);
  /// From the next step on, 0 to 0.4999 in float, to 0.499999 in double; wakes the body. Error: InvalidOption
  Status setPoissonRatio(double ratio);
  /// From the next step on, 0 or more; wakes the body. Error: InvalidOption
  Status setStiffnessDamping(double seconds);

  /// Sets the body's gravity, world length / s^2; until the first call it follows the world's, also when that changes.
  /// The body wakes. Error: InvalidOption for one that is not finite, or above 1e6 body sizes per second squared;
  /// nothing is changed then.
  Status setGravity(const btVector3& gravity);
  void followWorldGravity();  ///< undoes `setGravity`: gravity follows the world's again; wakes the body

  /// Pins a node where it is, or releases it with the mass that it had. Pinning a pinned node, and releasing a free
  /// one, changes nothing. The body wakes. Error: IndexOutOfRange.
  Status setPinned(int node, bool pinned = true);
  /// Moves a pinned node: it is at this position in the following steps, with the velocity of its motion. Call it once
  /// per frame, or once per step; the motion is spread over as many steps as lay between the last two calls. A node for
  /// which it is no longer called stays where it is. The body wakes. To put the whole body elsewhere, see `teleport`.
  /// position  world space
  /// Errors    IndexOutOfRange; InvalidOption for a node that is not pinned; NonFinite. On an error nothing is changed
  Status setPinnedPosition(int node, const btVector3& position);
  /// True if the node is pinned. The node must exist.
  bool isPinned(int node) const;

  /// Puts the body elsewhere in its motion: nodes, velocities, pinned nodes and their ways go along, so that the next
  /// step is the one that it would have made, and nothing on the way is met. What it has touched is forgotten; it, and
  /// what lies beside it, wakes. Springs, welds and anchors stay attached to what they hold. (Bullet's `translate`,
  /// `rotate` and `transform` leave velocities as they are.) Skins that interpolate: `SoftBodySkin::markTeleported`.
  /// Move the rigid bodies to which it is attached by the same motion, between the same two steps: they would pull it.
  /// motion  world space, from where the body is: x becomes motion * x
  /// Cost    O(nodes + faces)
  /// Errors  InvalidOption: not a rigid motion, or by more than Limits::kMaxCoordinate; the body is not in its world,
  ///         or within a step; nothing is changed then
  Status teleport(const btTransform& motion);

  /// Puts the body back into the state in which it was added: where it was then, at rest, with nothing remembered, so
  /// that its steps are those of a new body. What has been set stays: which nodes are pinned (they go to where they
  /// were, too), masses, material, gravity, groups, contacts, springs. It, and what lies beside it, wakes. After
  /// `shiftOrigin` it goes to the same place as the world has it now.
  /// Cost    some milliseconds for 1,000 tets, as `add`
  /// Errors  InvalidOption: the body was scaled, or got other nodes or tets, is not in its world, or within a step;
  ///         nothing is changed then
  Status reset();

 private:
  struct Impl;
  explicit DeformableBody(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
