// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/embedding.h>
#include <tetskin/elastic/elastic_law.h>
#include <tetskin/elastic/material_changes.h>

#include <memory>

namespace tetskin {

/// Which code computes and solves a body's elastic forces.
enum class SolverPath {
  Bullet,  ///< Bullet's own force
  Solver,  ///< ForceModel::Corotated, solved by a DeformableSolver
  None,    ///< no force: the body has left its world, or has tets that can no longer be simulated
};

/// A soft body in a deformable world, with its own gravity and elastic forces. Creates, separates and deletes the
/// objects that Bullet leaves to the application.
///
/// Bullet's `addForce` gives a second body the force of the first one of the same type, including its material, and
/// neither bodies nor forces are ever deleted. A DeformableBody has its own forces, which no other body joins, and
/// deletes them all in its destructor. Destroy it before the world. If the world was deleted first, this object only
/// frees its memory; a solver that outlives its world must then not be used in another one.
///
/// The application may remove the body from the world itself; the body then has no forces until `addToWorld`. If the
/// application has added the body to another world, it owns the body: this object's destructor leaves it there.
class TETSKIN_SOLVER_API DeformableBody {
 public:
  /// Creates the body (see `createSoftBody`) and adds it to the world. Unless `options.configureWorld` is false, also
  /// switches on the world's projection of contacts (without it soft bodies do not land: they hang or fall through) and
  /// applies `options.implicit` if given. Nothing else in the world is changed. Step the world with `stepSimulation(dt,
  /// 4, dt / 4)` at 60 frames per second; one substep per frame is too few.
  ///
  /// world   created with a `DeformableSolver`; Bullet's own forces also work with a btDeformableBodySolver. The
  ///         world's gravity at the time of the call sets the scale of the default stiffness
  /// cage    at the body's initial position, world space. Its volume fractions, stiffness factors and masses are used
  ///         unless the options give their own. ForceModel::Corotated simulates its quadratic tets as such, while the
  ///         btSoftBody holds each as eight linear tets, which Bullet's own force models use. They become linear if the
  ///         application changes the body's tets, or changes rest shapes to others than those of a tet with straight
  ///         edges
  /// Errors  those of `createSoftBody`. InvalidOption: ForceModel::MassSpring, which has no stable setting here;
  ///         ForceModel::Corotated in a world without a `DeformableSolver`, or with `options.implicit`; worlds of
  ///         reduced bodies
  static Result<std::unique_ptr<DeformableBody>> add(btDeformableMultiBodyDynamicsWorld& world, const Cage& cage,
                                                     const SoftBodyOptions& options = {});
  ~DeformableBody();
  DeformableBody(const DeformableBody&) = delete;
  DeformableBody& operator=(const DeformableBody&) = delete;

  /// Takes the body out of its world until `addToWorld`; meanwhile it costs the world nothing. It keeps its nodes,
  /// velocities, material, gravity, pins and collision filters. It also keeps its skins, its SurfaceContact, its place
  /// in SoftContacts, and its springs and welds, whose status is NotInWorld meanwhile. Forces of
  /// `SurfacePoint::applyForce` end. Neighbouring bodies wake. While it is out, a snapshot that was saved with it is
  /// refused: SnapshotMismatch. Does nothing to a body that is not in its world. May be called wherever bodies may be
  /// removed.
  void removeFromWorld();
  /// Puts the body back into its world, or into another one, where it continues; it wakes. Its skins and its
  /// SurfaceContact move to another world with it; SoftContacts, springs and welds stay with the world in which they
  /// were created, and act again when the body is back there. Also works for a body that the application has taken out
  /// by Bullet's own call (which keeps no filters), and may have added again.
  /// world   created with a solver as for `add`. The body follows this world's gravity unless its own was set
  /// Errors  InvalidOption: the body is in a world; the world has another solver, or a gravity too large for the body.
  ///         Nothing is changed on an error
  Status addToWorld(btDeformableMultiBodyDynamicsWorld& world);

  btSoftBody& body();              ///< Bullet's body, owned by this object
  const btSoftBody& body() const;  ///< Bullet's body, owned by this object

  ForceModel forceModel() const;  ///< the elastic model, from the options
  /// Which code solves for the body: while it is in its world, its force model decides.
  SolverPath solverPath() const;

  /// Young's modulus in use, in pressure units: the last one set, or the options' one, or the default for this cage,
  /// the world's gravity and `options.timeStep`.
  double youngsModulus() const;
  /// Young's modulus over density x gravity x size (the world's gravity when the body was added), dimensionless: from
  /// 30 (wobbles, sags) to 300 (firm). Below some 5 a body cannot support itself: its own weight flattens it.
  double relativeStiffness() const;
  double poissonRatio() const;      ///< Poisson's ratio in use, 0 to below 0.5
  double stiffnessDamping() const;  ///< stiffness-proportional (Rayleigh) damping in use, seconds

  /// Sets Young's modulus, in pressure units, above 0, from the next step on; the time step does not limit it. The body
  /// wakes. Error: InvalidOption, also for a body that is too stiff for its mass and size (E above 1e12 density size^2
  /// / s^2 in float, 1e16 in double); nothing is changed then.
  Status setYoungsModulus(double pressure);
  /// Applies from the next step on; 0 to 0.4999 in float, to 0.499999 in double. The body wakes. Error: InvalidOption
  Status setPoissonRatio(double ratio);
  /// Applies from the next step on; 0 or more. The body wakes. Error: InvalidOption
  Status setStiffnessDamping(double seconds);

  // ---- What changes the material, for ForceModel::Corotated alone: the calls of `ElasticBody` (tetskin/elastic),
  // which says what they do. Each acts from the next step on, wakes the body, and is part of snapshots. An error
  // (InvalidOption, also within a step, SizeMismatch or IndexOutOfRange) says what is wrong; nothing is changed then.
  // Tets are those of the cage. If the body is scaled, what has flowed is forgotten; if it gets other tets, all of it.

  Status setPlasticity(const Plasticity& plasticity);  ///< the material flows where it yields; replaces what was set
  Status endPlasticity();                              ///< nothing flows any more; what has flowed stays
  Status resetPlasticFlow();                           ///< the body returns to its first shape
  std::vector<double> plasticStrains() const;          ///< tetCount: how much each tet has flowed in all, 0 or more
  /// Tets grow to multiples of their first size, 0.05 to 20. In one step a large change is a blow: spread it over some.
  Status setGrowth(double length);
  Status setGrowth(const std::vector<double>& lengths);                             ///< the same by tet
  Status setGrowthTensors(const std::vector<std::array<double, 9>>& deformations);  ///< by tet, 3 x 3 by rows
  Status setStiffnessScale(const std::vector<double>& factors);  ///< tetCount, 1e-6 to 1e6: beside the cage's own
  Status setDampingScale(const std::vector<double>& factors);    ///< tetCount, 0 or more: beside what is painted
  Status setElasticLaw(const ElasticLaw& law, const std::vector<int>& tets = {});  ///< of these tets; none: of all
  Status addFibres(const Fibres& fibres);                                          ///< they cannot be removed
  Result<int> addMuscle(const Muscle& muscle);          ///< returns its number; it is relaxed
  Status setActivation(int muscle, double activation);  ///< 0 to 1
  double activation(int muscle) const;                  ///< 0 for a muscle that does not exist

  // ---- Pressure, for ForceModel::Corotated alone; see the page "Pressure and gas".

  /// Sets the pressure in the body, in pressure units above that outside, from the next step on; 0 ends it, and below 0
  /// it is suction. It follows the deformed surface: its forces are the pressure times the derivative of the volume
  /// inside, so that their sum and torque are 0. Which surface that is, the tets' boundary decides, unless
  /// `setPressureSurface` has named one: where it encloses hollows (a balloon, a tyre), the pressure is in all of them,
  /// and acts on their walls; otherwise it is in the body, and acts on its whole surface outwards. Needs
  /// ForceModel::Corotated. The body wakes.
  ///
  /// A thin sphere of radius R and wall t has no equilibrium above p = t E / (2 R (1 - nu)), where it is twice as large
  /// as at rest: its wall gives way faster than it tightens. It bursts to 64 times its volume at rest (of its surface,
  /// scaled with the body, without what `setGrowth` adds), above which the pressure falls, to 0 at 125 times. Suction
  /// falls to 0 below a tenth of the volume. The energy that a pressure supplies is the application's: blow a body up
  /// in a second, not in a step.
  /// Cost    per step: O(faces), about as much as an iteration of the solve; the first call: as `volume`
  /// Errors  NonFinite; InvalidOption: one of Bullet's force models; too large for the body's mass and size, as a
  ///         Young's modulus; tets that enclose nothing; within a step. Nothing is changed on an error
  Status setPressure(double pressure);
  /// Fills the body with a gas of this pressure, above that outside: in place of a constant pressure, its amount stays.
  /// At constant temperature, (pressure + outside) x volume keeps the value of now, so that the gas stiffens as it is
  /// compressed, as a tyre does. Where this is nothing (a pressure of 0 without `outside`), the gas is let out.
  /// pressure  gauge pressure, pressure units: above -outside
  /// outside   absolute pressure outside, at least 0. With 0, pressure x volume itself is constant, in any units: soft,
  ///           for a toy. A real balloon or tyre, in Pa, has 101325 around it: it hardly changes its volume
  /// Errors    those of `setPressure`; InvalidOption: out of these ranges, or a body that is crushed flat
  Status setGas(double pressure, double outside = 0.0);
  /// The pressure inside now, above that outside; 0: none. That of a gas belongs to its present volume.
  double pressure() const;
  /// The volume inside now: of the hollows, or of the body without any; of the surface that `setPressure` acts on. 0 if
  /// there is none, or with one of Bullet's force models. It works in memory of the body: not for two threads at once,
  /// nor is `pressure`. Cost O(faces), the first time O(T log T), and the hollows times the faces
  double volume() const;
  /// Sets the surface on which pressure acts, and whose volume counts: a mesh in the body, such as the visible one. Its
  /// hollows decide, as those of the tets do. A gas keeps its present pressure. If the body gets other tets, the
  /// surface is theirs again; pressure ends if they have none.
  /// mesh       at rest, closed; vertices at the same place count as one (texture seams); not kept
  /// embedding  of it in the body's cage; an empty one, with an empty mesh: the tets' boundary again; not kept
  /// Cost       O(triangles log triangles), and the hollows times the triangles
  /// Errors     SizeMismatch: mesh, embedding and body do not belong together; InvalidOption: the mesh is not closed,
  ///            encloses nothing, or joins parts of the cage that are not connected; those of `setPressure`. Nothing is
  ///            changed on an error
  Status setPressureSurface(const TriangleMesh& mesh, const Embedding& embedding);
  /// Prepares such a surface, which is made when pressure or volume are first asked for; where that fails, as the mesh
  /// is open, the tets' boundary serves. Does nothing while there is pressure. `World` does so for its bodies.
  /// mesh  kept
  void preparePressureSurface(std::shared_ptr<const TriangleMesh> mesh, const Embedding& embedding);

  /// Sets the body's gravity, world length / s^2. Until the first call the body follows the world's gravity, including
  /// later changes. The body wakes. Error: InvalidOption if not finite, or above 1e6 body sizes per second squared;
  /// nothing is changed then.
  Status setGravity(const btVector3& gravity);
  void followWorldGravity();  ///< undoes `setGravity`: gravity follows the world's again; wakes the body

  /// Pins a node where it is, or releases it with its former mass. Pinning a pinned node, or releasing a free one,
  /// changes nothing. The body wakes. Error: IndexOutOfRange.
  Status setPinned(int node, bool pinned = true);
  /// Moves a pinned node: in the following steps it reaches this position, with the velocity of its motion. Call it
  /// once per frame, or once per step; the motion is spread over as many steps as lay between the last two calls. When
  /// the calls stop, the node stays where it is. The body wakes. To move the whole body elsewhere, see `teleport`.
  /// position  world space
  /// Errors    IndexOutOfRange; InvalidOption for a node that is not pinned; NonFinite. Nothing is changed on an error
  Status setPinnedPosition(int node, const btVector3& position);
  /// True if the node is pinned. The node must exist.
  bool isPinned(int node) const;

  /// Moves the whole body by a rigid motion, without collisions on the way. Nodes, velocities, pinned nodes and their
  /// paths move along, so the next step is the one it would have made anyway. Contacts so far are forgotten; the body
  /// and its neighbours wake. Springs, welds and anchors stay attached at their other ends: move the rigid bodies to
  /// which it is attached by the same motion, between the same two steps, or they will pull it. (Bullet's `translate`,
  /// `rotate` and `transform` leave velocities unchanged.) For skins that interpolate, call
  /// `SoftBodySkin::markTeleported`.
  /// motion  world space, relative to the current place: x becomes motion * x
  /// Cost    O(nodes + faces)
  /// Errors  InvalidOption: not a rigid motion; beyond Limits::kMaxCoordinate; the body is not in its world, or within
  ///         a step; nothing is changed then
  Status teleport(const btTransform& motion);

  /// Restores the state in which the body was added: in its place then, at rest, without history, so that its steps are
  /// those of a new body. Settings stay: which nodes are pinned (these also return to their places), masses, material,
  /// gravity, groups, contacts, springs. The body and its neighbours wake. After `shiftOrigin` it returns to the same
  /// physical place, in the world's present coordinates.
  /// Cost    some milliseconds for 1,000 tets, as `add`
  /// Errors  InvalidOption: the body was scaled, was given other nodes or tets, is not in its world, or within a step;
  ///         nothing is changed then
  Status reset();

 private:
  struct Impl;
  explicit DeformableBody(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
