// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/deformable_body.h>

#include <memory>
#include <vector>

#include "report/scene_setup.h"
#include "scenes/deformable_world.h"

namespace tetskin::report {

/// What every cage of a comparison is made of, and how it is stepped.
struct Material {
  ForceModel forceModel = ForceModel::LinearElasticity;
  double youngsModulus = 0.0;  ///< pressure units
  double poissonRatio = 0.3;
  double damping = 0.0;  ///< seconds
  double density = 0.0;  ///< mass per volume
  double margin = 0.0;   ///< collision margin
  int substeps = 4;      ///< of a frame
  bool implicit = false;
};

/// For all cages of a scene. Chosen by the reference, which is the least stable: in the sag and the twist linear
/// elasticity, which Bullet turns with each tet, and whose damping then keeps any stiffness stable; in the drop, where
/// that sinks into the ground, neo-Hookean elasticity, with as many substeps as its stiffness needs in a landing.
/// relativeStiffness  Young's modulus over density x gravity x size; 0: the scene's own
Material materialOf(SceneKind kind, const TetMesh& reference, double relativeStiffness, bool implicit);

/// A cage in a scene, simulated by Bullet.
class BodyScene {
 public:
  /// Throws InputError if Bullet cannot make a body of the cage, or if the scene holds none of its nodes.
  BodyScene(const SceneSetup& setup, const TetMesh& cage, const Material& material);

  btSoftBody& body() { return body_->body(); }
  /// Advances by one frame; `frame` is the one reached.
  void step(int frame);

 private:
  void moveHeldNodes(double frame, double seconds);

  SceneSetup setup_;
  int substeps_;
  std::vector<Eigen::Vector3d> rest_;
  std::vector<int> held_;
  scenes::DeformableWorld world_;
  std::unique_ptr<DeformableBody> body_;
};

}  // namespace tetskin::report
