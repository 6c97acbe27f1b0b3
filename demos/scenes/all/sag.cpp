// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/table.h"

namespace tetskin::scenes {

namespace {

/// Holds the nodes below a share of the box's extent along an axis.
std::unique_ptr<Scene> heldBelow(int axis, double share, const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  const Box3 box = layoutBox(options, cage);
  const double limit = box.min()[axis] + share * box.sizes()[axis];
  const auto held = [axis, limit](const Eigen::Vector3d& p) { return p[axis] <= limit; };
  (void)nodesWhere(cage, held);
  scene->add(cage, held);
  return scene;
}

}  // namespace

/// The body is pinned at its lower end, as if it stood in the ground.
std::unique_ptr<Scene> makeSag(const Cage& cage, const SceneOptions& options) {
  return heldBelow(1, 0.35, cage, options);
}

/// The body is held by the left side of its box. For beams, whose nodes there are in one plane in any mesh.
std::unique_ptr<Scene> makeCantilever(const Cage& cage, const SceneOptions& options) {
  return heldBelow(0, 1e-4, cage, options);
}

}  // namespace tetskin::scenes
