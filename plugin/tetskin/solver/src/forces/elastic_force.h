// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the corotated elasticity of one body, as an entry in Bullet's list of forces.
#pragma once

#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/forces/forced_bodies.h>

namespace tetskin::bullet_detail {

/// A `DeformableSolver` finds the body by this entry and solves for it; to Bullet the force is always 0. It is in the
/// list so that Bullet reports when the body leaves the world, and can ask for its energy.
///
/// Corotated linear elasticity: every tet's rotation is removed from its deformation. So a tet neither resists rotation
/// nor swells by it, as in linear elasticity, and it recovers from being flat or inverted. A quadratic tet has four
/// such rotations.
class ElasticForce : public InactiveForce {
 public:
  /// linear          tets of the body: see `restTetsOf`
  /// material        checked: see `checkMaterial`
  /// stiffnessScale  tetCount, above 0; or empty: 1
  /// paintedDamping  tetCount, 0 or more; or empty: 1
  /// quadratic       of the body's cage
  ElasticForce(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body, const elastic_detail::RestTets& linear,
               const ElasticMaterial& material, std::vector<double> stiffnessScale, std::vector<double> paintedDamping,
               std::vector<QuadraticShape> quadratic, const SolverSettings& settings);

  void setMaterial(const ElasticMaterial& material);
  /// Gives the tets what the owner has set in `body().changes`.
  void applyChanges() { body_.applyChanges(material_); }
  /// The same of growth and muscles alone.
  void applyShapes() { body_.applyShapes(material_); }
  /// Forgets all steps. The body must still have the tets and rest shapes with which it was created.
  void reset();
  /// The world that its body is about to enter.
  void setWorld(btDeformableMultiBodyDynamicsWorld& world);
  const ElasticMaterial& material() const { return material_; }
  const SolverSettings& settings() const { return settings_; }
  ForcedBody& body() { return body_; }

  /// Called in each step: rebuilds whatever the application has changed in the body.
  void reinitialize(bool nodeUpdated) override;
  double totalElasticEnergy(btScalar dt) override;

  void serialize(WorldStream& stream) override;
  void checkState(WorldStream& stream) override;

 private:
  ElasticMaterial material_;
  SolverSettings settings_;
  ForcedBody body_;
};

}  // namespace tetskin::bullet_detail
