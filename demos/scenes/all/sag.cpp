// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/table.h"

namespace tetskin::scenes {

/// The body is pinned at its lower end, as if it stood in the ground.
std::unique_ptr<Scene> makeSag(const Cage& cage, const SceneOptions& options) {
  constexpr double kFootFraction = 0.35;  // share of the height
  auto scene = std::make_unique<Scene>(options, kEarth);
  const Box3 box = layoutBox(options, cage);
  const double foot = box.min().y() + kFootFraction * box.sizes().y();
  const auto held = [foot](const Eigen::Vector3d& p) { return p.y() <= foot; };
  (void)nodesWhere(cage, held);
  scene->add(cage, held);
  return scene;
}

/// The body is held by the left side of its box. For beams, whose nodes there are in one plane in any mesh.
std::unique_ptr<Scene> makeCantilever(const Cage& cage, const SceneOptions& options) {
  constexpr double kHeldFraction = 1e-4;  // share of the length
  auto scene = std::make_unique<Scene>(options, kEarth);
  const Box3 box = layoutBox(options, cage);
  const double end = box.min().x() + kHeldFraction * box.sizes().x();
  const auto held = [end](const Eigen::Vector3d& p) { return p.x() <= end; };
  (void)nodesWhere(cage, held);
  scene->add(cage, held);
  return scene;
}

}  // namespace tetskin::scenes
