// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/parallel_for.h>

#include <memory>

namespace tetskin {

class ForceRecord;
class SystemSolve;

/// Bullet's solver of deformable bodies, with a solve of our own: what the application makes instead of a
/// `btDeformableBodySolver`, and gives to its world and to its constraint solver just as that.
///
/// Bodies of `ForceModel::Corotated` are solved for implicitly, before contacts are looked for, and again where there
/// are any: with contacts and Bullet's anchors as rows of one system, until it has converged. Dynamic rigid bodies and
/// multibodies that are touched are unknowns of it, and so are those that these touch or hang on, as long as there are
/// fewer than 24; their own contacts and joints begin as Bullet has left them. Bullet's constraints of such contacts
/// and anchors are taken out before Bullet solves for them. All other bodies are solved for as Bullet does in an
/// explicit world with projection of contacts, with its forces. A body asleep costs a look at what is beside it.
/// `ForceModel::Corotated`, tetskin::contact and tetskin::touch need this solver, and a world with any of them is
/// solved here whatever its settings of Bullet's solve are. A world of Bullet's forces alone that is implicit, has line
/// search, or no projection (Bullet's default; `setUseProjection(true)` switches it on, and so does
/// `DeformableBody::add`) is solved by Bullet's own code.
///
/// Contact by nodes asks for groups, masks, the world's overlap filter callback and the responses of both bodies in
/// each step. Bodies that sleep wake where what they lie on, or hang on, is moved, changed or taken away, and where an
/// obstacle comes near; see the guide.
///
/// A body whose collision flags let it meet no soft body (as `makeSoftBody` makes them) is marked as sleeping between
/// the solve and its integration, so that Bullet does not look for such meetings; that is seen in a world's solver
/// callback alone.
class TETSKIN_BULLET_API DeformableSolver : public btDeformableBodySolver {
 public:
  /// Of no bodies, which Bullet tells it of in each step.
  DeformableSolver();
  ~DeformableSolver() override;
  DeformableSolver(const DeformableSolver&) = delete;
  DeformableSolver& operator=(const DeformableSolver&) = delete;

  /// Lends threads, or takes them back with null; valid until then. Steps have the same bits with any number.
  void setThreads(ParallelFor* threads);

  /// Bullet's m_n of the nodes, which drawing a body's own faces needs and a skin does not. On at first.
  void setNodeNormals(bool on);

  /// From now on every step is solved here, whatever settings of Bullet's solve the world has: implicit, line search,
  /// projection. What `DeformableBody::add` with ForceModel::Corotated, and contacts and joints call.
  void solveAlways();
  /// Whether this solver's own solve is in use: always after `solveAlways`, else by the world's settings of the last
  /// step; true before the first.
  bool solves() const;
  /// Iterations of the conjugate gradient in the last step, over all bodies; 0 if Bullet's own code has solved it.
  int iterations() const;

  /// Linear solves of the last step, over all bodies on which something beside elasticity acts; those that are solved
  /// for together count once.
  int passes() const;
  /// How many of these systems with contacts were given up before they had converged: their bodies go on with what the
  /// last pass has found.
  int unconverged() const;

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
  struct Parts;
  friend struct Parts;
  friend class ForceRecord;
  friend class SystemSolve;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
