// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/table.h"

namespace tetskin::scenes {

/// The body is pinned at its lower end, as if it stood in the ground.
std::unique_ptr<Scene> makeSag(const Cage& cage, const SceneOptions& options) {
  constexpr int kUp = 1;
  constexpr double kShare = 0.35;  // of the box's height
  auto scene = std::make_unique<Scene>(options, kEarth);
  const Box3 box = layoutBox(options, cage);
  const double limit = box.min()[kUp] + kShare * box.sizes()[kUp];
  const auto held = [limit](const Eigen::Vector3d& p) { return p[kUp] <= limit; };
  (void)nodesWhere(cage, held);
  scene->add(cage, held);
  return scene;
}

}  // namespace tetskin::scenes
