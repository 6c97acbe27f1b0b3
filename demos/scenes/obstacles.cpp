// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/obstacles.h"

namespace tetskin::scenes {
namespace {

/// Initial height of the lowest node above the highest obstacle.
constexpr double kDropHeight = 0.6;
/// Contacts may be at nodes only, so obstacles are large, and round or flat: a body with few nodes falls around an
/// edge.
constexpr double kDomeRadius = 1.2;
constexpr double kDomeHeight = 0.3;
constexpr double kRampSlope = 0.3;  ///< radians
constexpr double kGroundHalfSide = 10.0;

}  // namespace

/// The body may fall asleep.
std::unique_ptr<Scene> makeObstacles(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  World& world = scene->world();
  scene->floorY = 0.0;
  world.addBox({0.0, -1.0, 0.0}, {kGroundHalfSide, 1.0, kGroundHalfSide});
  world.addBox({-1.4, -0.35, 0.0}, {1.2, 0.5, 2.0}, -kRampSlope);  // its upper side descends to the right
  world.paint("ramp");
  world.addSphere({0.6, kDomeHeight - kDomeRadius, 0.0}, kDomeRadius);

  const double height = kDomeHeight + kDropHeight + 0.5 * layoutBox(options, cage).sizes().y();
  scene->offset.y() += height;
  if (options.force == Force::Reduced) {  // its modes refer to the cage's position
    scene->add(cage, {}, {0.0, height, 0.0}).forceActivationState(ACTIVE_TAG);
    return scene;
  }
  TetMesh lifted = cage.mesh;  // moved before it becomes a body: a body that is moved later is not exactly equal
  for (Eigen::Vector3d& p : lifted.nodes) p.y() += height;
  scene->add(lifted).forceActivationState(ACTIVE_TAG);
  return scene;
}

}  // namespace tetskin::scenes
