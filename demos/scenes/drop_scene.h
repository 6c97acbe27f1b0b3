// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/triangle_mesh.h>

#include <memory>
#include <vector>

#include "scenes/deformable_world.h"

namespace tetskin::scenes {

/// A model falls on a floor and a few obstacles. It may have any size and be anywhere: Bullet has absolute constants
/// (sleep thresholds, clamps), so it simulates the model scaled to `kSize`, and results are in the model's own space
/// again. Frame 0 is the model at rest; the floor lies below it.
class DropScene {
 public:
  /// Largest side of the simulated cage.
  static constexpr double kSize = 2.0;
  /// Frames a second, and substeps a frame.
  static constexpr double kFrameRate = 60.0;
  static constexpr int kSubsteps = 4;

  /// Mesh and cage are usable (see `loadModel`). Check `fit()` before stepping.
  DropScene(const TriangleMesh& mesh, const TetMesh& cage, const SkinOptions& skin);

  const EmbedReport& fit() const { return fit_; }

  /// Advances by one frame. Returns false if the skin found node positions that are not finite.
  bool step();

  /// Current vertices in the model's space, vertexCount; kept until the next step.
  const std::vector<Eigen::Vector3d>& surface() const { return surface_; }
  /// Its current normals; empty if not asked for.
  PointView<const float> normals() const { return skin_.normals(); }
  /// Box of the surface, model's space.
  Box3 bounds() const;
  /// The cage as it is now, model's space.
  TetMesh currentCage() const;
  /// The floor and the obstacles, model's space.
  TriangleMesh obstacles() const;

  double floorY() const;                          ///< model's space
  double margin() const;                          ///< collision margin, model's unit
  double size() const { return kSize / scale_; }  ///< largest side of the rest cage, model's unit
  /// Root mean square of the nodes' speeds, in sizes a second.
  double nodeSpeed() const;

  double simulationMs() const { return simulationMs_; }  ///< of the last step
  double skinUs() const { return skinUs_; }              ///< of the last step

 private:
  Eigen::Vector3d toModel(const Eigen::Vector3d& simulated) const;
  void addObstacles();
  void addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope);
  void addSphere(const Eigen::Vector3d& centre, double radius);
  void readSurface();

  Eigen::Vector3d centre_;  ///< model's space: of the cage's box
  Eigen::Vector3d start_;   ///< simulated space: where that centre starts
  double scale_;            ///< simulated over model's lengths
  const TetMesh& restCage_;

  DeformableWorld world_;
  TriangleMesh obstacles_;  ///< simulated space
  std::unique_ptr<DeformableBody> body_;
  SoftBodySkin skin_;
  EmbedReport fit_;
  std::vector<Eigen::Vector3d> surface_;
  double simulationMs_ = 0.0;
  double skinUs_ = 0.0;
};

}  // namespace tetskin::scenes
