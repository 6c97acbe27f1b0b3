// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <tetskin/bullet/elastic_force.h>
#include <tetskin/core/parallel_for.h>

#include <memory>

namespace tetskin {

/// Bullet's solver of deformable bodies, with a solve of our own: what the application makes instead of a
/// `btDeformableBodySolver`, and gives to its world and to its constraint solver just as that.
///
/// Bodies with an `ElasticForce` are solved for implicitly before contacts are looked for, and again under the contacts
/// that Bullet finds and solves; all others as Bullet does, with its forces. Bodies asleep cost nothing here. A world
/// without projection of contacts (Bullet's default; `setUseProjection(true)` switches it on, and so does
/// `DeformableBody::add`) or with line search is solved by Bullet's own code, see `solves`.
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

  /// Whether this solver's own solve is in use, by the world's settings of the last step; true before the first.
  bool solves() const;
  /// Iterations of the conjugate gradient in the last step, over all bodies; 0 if Bullet's own code has solved it.
  int iterations() const;

  /// What contacts with rigid bodies have pushed a node with in the last step, along the contact's normal, as solved
  /// for here; 0 for a body that was not, which Bullet's constraints tell.
  btScalar normalImpulse(const btSoftBody& body, int node) const;

  // What Bullet calls.
  void reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) override;
  void predictMotion(btScalar dt) override;
  void solveDeformableConstraints(btScalar dt) override;
  void applyTransforms(btScalar dt) override;
  void updateSoftBodies() override;

 private:
  struct Parts;
  friend struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
