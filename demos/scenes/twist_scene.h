// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <memory>
#include <vector>

#include "scenes/deformable_world.h"
#include "scenes/twist.h"

namespace tetskin::scenes {

struct Model;

/// A body without weight, held at both ends of its longest side. One end is turned, and may be let go; the body carries
/// a linear and a quadratic surface. As in DropScene, Bullet simulates the model scaled to `kSize`, and results are in
/// the model's own space.
class TwistScene {
 public:
  static constexpr double kSize = 2.0;
  static constexpr double kFrameRate = 60.0;
  static constexpr int kSubsteps = 4;

  /// Mesh and cage are usable (see `loadModel`), and outlive the scene. Check `fit()` before stepping.
  TwistScene(const Model& model, const SkinOptions& skin);

  const EmbedReport& fit() const { return fit_; }

  /// Advances by one frame, at the end of which the moved end has turned by `turn` radians in all. Returns false if
  /// node positions are not finite.
  bool step(double turn);
  /// Lets go of the moved end.
  void release();

  /// Current vertices, vertexCount each, and normals, if asked for.
  const std::vector<Eigen::Vector3d>& linear() const { return linearSurface_; }
  const std::vector<Eigen::Vector3d>& quadratic() const { return quadraticSurface_; }
  PointView<const float> linearNormals() const { return linear_.normals(); }
  PointView<const float> quadraticNormals() const { return quadratic_.normals(); }
  /// Root mean square distance of the nodes to an even twist between the held ends, in diagonals of the mesh's box.
  double nodesOffTwist() const;

  double simulationMs() const { return simulationMs_; }  ///< of the last step
  double linearUs() const { return linearUs_; }          ///< update of the linear surface
  double quadraticUs() const { return quadraticUs_; }

 private:
  Eigen::Vector3d toModel(const btScalar* simulated) const;
  void moveHeldNodes(double seconds);
  bool updateSkins();
  void readSurface(const SoftBodySkin& skin, std::vector<Eigen::Vector3d>& surface) const;

  const TetMesh& cage_;
  double diagonal_;        ///< of the mesh's box
  Twist twist_;            ///< between the held ends, model's space
  double scale_;           ///< simulated over model's lengths
  std::vector<int> held_;  ///< nodes of both ends, until the moved one is let go

  DeformableWorld world_{btVector3(0, 0, 0)};
  std::unique_ptr<DeformableBody> body_;
  SoftBodySkin linear_, quadratic_;
  EmbedReport fit_;
  std::vector<Eigen::Vector3d> linearSurface_, quadraticSurface_;
  double simulationMs_ = 0.0, linearUs_ = 0.0, quadraticUs_ = 0.0;
};

/// The twist of a whole body along the longest side of its box, from one end to the other.
Twist twistOf(const Box3& box, double turn);

}  // namespace tetskin::scenes
