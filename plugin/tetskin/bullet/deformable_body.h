// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>

#include <memory>

namespace tetskin {

/// Whose force a body has, and whose solve.
enum class SolverPath {
  Bullet,  ///< Bullet's force
  Solver,  ///< ForceModel::Corotated, which a DeformableSolver solves for
  None,    ///< no force: the body has been taken out of its world
};

/// A soft body in a deformable world, with gravity and elastic forces of its own: what Bullet leaves to the application
/// to create, to keep apart and to delete.
///
/// Bullet's `addForce` gives a second body the first one's force of the same type, material and all, and neither bodies
/// nor forces are ever deleted. Here every body has its own, which no body of the application's ever joins, and all go
/// when this object goes. That should be before the world does. If the world has been deleted first, this object only
/// frees its memory; but a solver that outlives its world must not be used in another one then.
///
/// The application may take the body out of the world itself: it then has no forces any more. If it has put the body
/// into another world, the body is the application's own: it stays there when this object goes, and is not deleted.
class TETSKIN_BULLET_API DeformableBody {
 public:
  /// Makes the body (see `makeSoftBody`) and adds it to the world. Unless `options.configureWorld` is false, switches
  /// on the world's projection of contacts, without which soft bodies do not land but hang, or fall through, and sets
  /// what `options.implicit` says, if it is given; nothing else in the world is changed. Step it with
  /// `stepSimulation(dt, 4, dt / 4)` for 60 frames a second; one substep a frame is too few.
  ///
  /// world   made with a `DeformableSolver`; for Bullet's own forces a btDeformableBodySolver does, too. Its gravity
  ///         now serves as the scale of the default stiffness
  /// cage    where the body shall be, world space; its fill, factor and masses count where the options leave them out
  /// Errors  those of `makeSoftBody`; InvalidOption for ForceModel::MassSpring, which has no stable setting here, for
  ///         ForceModel::Corotated in a world without a `DeformableSolver`, or with `options.implicit`, and for the
  ///         worlds of reduced bodies
  static Result<std::unique_ptr<DeformableBody>> add(btDeformableMultiBodyDynamicsWorld& world, const Cage& cage,
                                                     const SoftBodyOptions& options = {});
  ~DeformableBody();
  DeformableBody(const DeformableBody&) = delete;
  DeformableBody& operator=(const DeformableBody&) = delete;

  btSoftBody& body();              ///< Bullet's own, of which this is the owner
  const btSoftBody& body() const;  ///< the same

  ForceModel forceModel() const;  ///< what holds it together
  /// By its force model, as long as it is in its world.
  SolverPath solverPath() const;

  /// The stiffness in use, in pressure units: the last one set, or that of the options, or the default for this cage,
  /// the world's gravity and `options.timeStep`.
  double youngsModulus() const;
  /// The same over density, gravity (of the world when the body was added) and size: from 30 (wobbles, sags) to 300
  /// (firm). Below some 5 a body cannot hold itself up: its own weight flattens it.
  double relativeStiffness() const;
  double poissonRatio() const;  ///< 0 to below 0.5
  double damping() const;       ///< seconds

  /// The body's material from the next step on; it wakes. As in SoftBodyOptions, but the stiffness must be above 0, and
  /// is not bounded by the time step. Errors: InvalidOption, also for what is too stiff for the body's mass and size
  /// (in float above 1e12 density size^2 / s^2, in double 1e16), and nothing is changed.
  Status setYoungsModulus(double pressure);
  Status setPoissonRatio(double ratio);  ///< likewise
  Status setDamping(double seconds);     ///< likewise

  /// Gravity follows the world's, also when that changes, until it is set here. The body wakes. Error: InvalidOption
  /// for one that is not finite, or above 1e6 sizes per second squared; nothing is changed.
  Status setGravity(const btVector3& gravity);
  void followWorldGravity();  ///< again, as at first

  /// Holds a node where it is. To move a pinned node, set the m_x of `body().m_nodes[node]` before the world steps,
  /// once a frame or once a step, or set its m_v, by which it goes on; a body that sleeps has to be activated. With a
  /// `DeformableSolver` a node that is moved by its m_x has the velocity of its motion: it is spread over as many steps
  /// as lay between the last two times that the node was moved. Where all of the body is put elsewhere (`translate`,
  /// `rotate`, `transform`, or the m_x of free nodes, too) nothing is given a velocity. The body wakes. Errors:
  /// IndexOutOfRange; that it is pinned already is none.
  Status pin(int node);
  /// Lets it go again, with the mass that it had; likewise.
  Status unpin(int node);
  /// The node exists.
  bool isPinned(int node) const;

 private:
  struct Parts;
  explicit DeformableBody(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
