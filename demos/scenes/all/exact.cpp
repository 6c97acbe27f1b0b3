// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/table.h"
#include "scenes/twist.h"

namespace tetskin::scenes {

/// The interpolation is the only source of error here.
std::unique_ptr<Scene> makeExact(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, 0.0);
  const Twist map = smoothTwistOf(layoutBox(options, cage));
  (void)scene->add(cage, [](const Eigen::Vector3d&) { return true; });
  scene->beforeFrame = [s = scene.get(), rest = cage.mesh.nodes, map](int, const Moved& moved) {
    for (std::size_t n = 0; n < rest.size(); ++n) {
      placeNode(s->body().m_nodes[static_cast<int>(n)], toBullet(map.point(rest[n]) + s->offset));
    }
    moved();
  };
  return scene;
}

}  // namespace tetskin::scenes
