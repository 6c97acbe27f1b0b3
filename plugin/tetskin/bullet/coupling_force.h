// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableLagrangianForce.h>
#include <tetskin/bullet/soft_body.h>

#include <array>
#include <vector>

namespace tetskin {

/// A force between bodies, which are others in each step. It reads positions and velocities of nodes, not what Bullet
/// keeps for each tet, so that a `DeformableSolver` need not have that updated, and solves for those bodies together
/// that it couples in a step. What that solver asks for is `addScaledExplicitForce`, `addScaledDampingForce` and
/// `addScaledDampingForceDifferential`; it is nothing to Bullet's own.
class TETSKIN_BULLET_API CouplingForce : public btDeformableLagrangianForce {
 public:
  ~CouplingForce() override;

  /// The bodies that the force acts on in this step, in pairs; of one with itself, twice that one. Asked for after
  /// `reinitialize`.
  virtual const std::vector<std::array<btSoftBody*, 2>>& pairs() const = 0;

  /// What a `DeformableSolver` solves its bodies' systems to at most, instead of their own tolerance: a load on a few
  /// nodes is a small part of what a body's residual is measured by.
  virtual double tolerance() const { return 1.0; }

  /// Of Bullet's implicit solve: nothing.
  void addScaledForces(btScalar, TVStack&) override {}
  /// Likewise.
  void addScaledElasticForceDifferential(btScalar, const TVStack&, TVStack&) override {}
  /// Of Bullet's preconditioner: nothing.
  void buildDampingForceDifferentialDiagonal(btScalar, TVStack&) override {}

  /// None of Bullet's, so that `addForce` joins nobody's body to it.
  btDeformableLagrangianForceType getForceType() override;
};

}  // namespace tetskin
