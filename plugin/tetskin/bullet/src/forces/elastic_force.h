// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the corotated elasticity of one body, as it stands in Bullet's list of forces.
#pragma once

#include <tetskin/bullet/src/forces/forced_bodies.h>
#include <tetskin/bullet/src/shared/forces/body_forces.h>

namespace tetskin {

/// A `DeformableSolver` finds the body here, and solves for it: the force itself gives Bullet nothing. It is in the
/// list so that Bullet tells when the body leaves the world, and asks for its energy.
///
/// Corotated linear elasticity: every tet's rotation is taken out of its deformation, so that it resists neither
/// turning nor, like linear elasticity, gets fatter by it; it comes back from being flat or inside out.
class ElasticForce : public SilentForce {
 public:
  /// rest            the body's: see `restTetsOf`
  /// material        checked: see `checkMaterial`
  /// stiffnessScale  tetCount, above 0; or empty: 1
  ElasticForce(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body, elastic_detail::RestTets rest,
               const ElasticMaterial& material, std::vector<double> stiffnessScale, const SolverLimits& limits);

  void setMaterial(const ElasticMaterial& material);
  const SolverLimits& limits() const { return limits_; }
  ForcedBody& body() { return body_; }

  /// Of each step: builds anew what the application has changed of the body.
  void reinitialize(bool nodeUpdated) override;
  double totalElasticEnergy(btScalar dt) override;

 private:
  ElasticMaterial material_;
  SolverLimits limits_;
  ForcedBody body_;
};

}  // namespace tetskin
