// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableLagrangianForce.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body_builder.h>

#include <memory>
#include <vector>

namespace tetskin {

/// A soft body in a deformable world, with gravity and elastic forces of its own: what Bullet leaves to the application
/// to create, to keep apart and to delete.
///
/// Bullet's `addForce` gives a second body the first one's force of the same type, material and all, and neither bodies
/// nor forces are ever deleted. Here every body has its own, and all go when this object goes, which must be before
/// the world does.
class DeformableBody {
 public:
  /// Makes the body (see `makeSoftBody`) and adds it to the world. The world is set to the one way of solving in which
  /// bodies land and rest: projected contacts, no line search, explicit unless `options.implicit`. Step it with
  /// `stepSimulation(dt, 4, dt / 4)` for 60 frames a second; one substep a frame is too few.
  ///
  /// world   must have been made with a btDeformableBodySolver, and its gravity set
  /// cage    where the body shall be, world space
  /// Errors  those of `makeSoftBody`; InvalidOption for ForceModel::MassSpring, which has no stable setting here
  static Result<std::unique_ptr<DeformableBody>> add(btDeformableMultiBodyDynamicsWorld& world, const TetMesh& cage,
                                                     const SoftBodyOptions& options = {});
  ~DeformableBody();
  DeformableBody(const DeformableBody&) = delete;
  DeformableBody& operator=(const DeformableBody&) = delete;

  btSoftBody& body() { return *body_; }
  const btSoftBody& body() const { return *body_; }
  /// The stiffness in use, in pressure units: that of the options, or the default for this cage and gravity.
  double youngsModulus() const { return youngsModulus_; }

 private:
  DeformableBody(btDeformableMultiBodyDynamicsWorld& world, std::unique_ptr<btSoftBody> body);
  void addForces(const TetMesh& cage, const SoftBodyOptions& options);

  btDeformableMultiBodyDynamicsWorld& world_;
  std::unique_ptr<btSoftBody> body_;
  std::vector<std::unique_ptr<btDeformableLagrangianForce>> forces_;
  double youngsModulus_ = 0.0;
};

}  // namespace tetskin
