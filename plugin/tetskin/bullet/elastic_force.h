// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Elasticity for Bullet's deformable world that keeps spin, and costs a fraction of Bullet's own.
#pragma once

#include <BulletSoftBody/btDeformableLagrangianForce.h>
#include <tetskin/bullet/soft_body.h>

#include <memory>
#include <vector>

class btDeformableMultiBodyDynamicsWorld;

namespace tetskin {

struct ForcedBody;

/// What a body resists deformation with.
struct ElasticMaterial {
  double youngsModulus = 0.0;  ///< in pressure units, above 0
  double poissonRatio = 0.3;   ///< 0 to below 0.5
  double damping = 0.02;       ///< seconds: damping forces are this times the rate of the elastic ones
};

/// How closely the velocities of a step are solved for. The defaults are for what is looked at; see the README for what
/// they cost in accuracy.
struct SolverLimits {
  double tolerance = 5e-3;  ///< of the residual over that without elasticity; 0 to below 1
  int iterations = 100;     ///< of the conjugate gradient in a step, at most; at least 1
};

/// Corotated linear elasticity of tet bodies: every tet's rotation is taken out of its deformation, so that it resists
/// neither turning nor, like linear elasticity, gets fatter by it; it comes back from being flat or inside out, and
/// may be turned by any angle at once. Steps are implicit, and conserve momentum.
///
/// Works in any deformable world with any btDeformableBodySolver; with a `DeformableSolver` it is solved for by that,
/// at a fraction of the time, is stable in free motion from soft to a stiffness of 1e12 density size^2 / s^2 (in double
/// 1e16), which is the most that is taken, at any spin below one radian per step, and is stable in contact. One object
/// may have several bodies, of one material: that is what Bullet's `addForce` does with a second object of this type.
/// `addTo` keeps each object to its own.
///
/// Ownership  the application's, as of all of Bullet's forces: it must outlive its bodies' time in the world
/// Cost       of a step, by itself: O(T) for T tets; memory about 700 bytes a tet in float
class TETSKIN_BULLET_API ElasticForce : public btDeformableLagrangianForce {
 public:
  /// Of no body: see `addTo`.
  /// material  what makes no sense is found by `addTo`
  explicit ElasticForce(const ElasticMaterial& material);
  ~ElasticForce() override;
  ElasticForce(const ElasticForce&) = delete;
  ElasticForce& operator=(const ElasticForce&) = delete;

  /// Acts on the body from now on, in this world, which it must be in. The tets' rest shapes are Bullet's
  /// (m_Dm_inverse), as `makeSoftBody` and Bullet's own helpers leave them.
  ///
  /// stiffnessScale  tetCount, above 0: times the material's stiffness; empty: 1
  /// Errors          SizeMismatch, InvalidOption; Degenerate for a body without tets, or with flat ones, or with tets
  ///                 that name no node of it
  Status addTo(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body, std::vector<double> stiffnessScale = {});

  /// Takes it from the body, and out of the world if it has no other; Bullet's `removeForce` finds the first force of a
  /// type, which may be another one.
  void removeFrom(btSoftBody& body);

  const ElasticMaterial& material() const;  ///< of all bodies
  /// Of all bodies, from the next step on; they are not woken. Error: InvalidOption
  Status setMaterial(const ElasticMaterial& material);
  /// By tet, above 0, for a body that the force has; empty: 1. Errors: SizeMismatch, InvalidOption, IndexOutOfRange
  Status setStiffnessScale(btSoftBody& body, std::vector<double> stiffnessScale);
  /// Used by `DeformableSolver` alone. Error: InvalidOption
  Status setLimits(const SolverLimits& limits);
  const SolverLimits& limits() const;  ///< in use

  // What Bullet calls.
  btDeformableLagrangianForceType getForceType() override;
  /// A body without tets, or with flat ones, is left alone.
  void addSoftBody(btSoftBody* body) override;
  void removeSoftBody(btSoftBody* body) override;
  void reinitialize(bool nodeUpdated) override;
  void addScaledForces(btScalar scale, TVStack& force) override;
  void addScaledExplicitForce(btScalar scale, TVStack& force) override;
  void addScaledDampingForce(btScalar scale, TVStack& force) override;
  void addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) override;
  void addScaledElasticForceDifferential(btScalar scale, const TVStack& dx, TVStack& df) override;
  void buildDampingForceDifferentialDiagonal(btScalar scale, TVStack& diagonal) override;
  double totalElasticEnergy(btScalar dt) override;

 private:
  friend class SolverBodies;  // which solves for the bodies in the force's place
  struct Parts;
  const std::vector<std::unique_ptr<ForcedBody>>& bodies() const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
