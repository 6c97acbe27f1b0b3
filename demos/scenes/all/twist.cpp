// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/twist.h"

#include "scenes/serpent_spine.h"
#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

/// Shares of the height that are pinned: the lower end, as if it stood in the ground, and the upper end.
constexpr double kFootFraction = 0.35, kTopFraction = 0.2;
/// Rotation of the moved end relative to the other, radians.
constexpr double kTurn = 1.5;
/// Share of the frames in which the end is turned; after that, it stays.
constexpr double kTurningFraction = 0.75;

}  // namespace

std::unique_ptr<Scene> makeTwist(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, 0.0);
  const Box3 box = layoutBox(options, cage);
  Twist twist = twistOf(box, 0.0);
  twist.axis = 1;
  twist.from = box.min().y() + kFootFraction * box.sizes().y();
  twist.to = box.max().y() - kTopFraction * box.sizes().y();
  const auto isPinned = [=](const Eigen::Vector3d& p) { return p.y() <= twist.from || p.y() >= twist.to; };
  const std::vector<int> pinned = nodesWhere(cage, isPinned);
  btSoftBody& body = scene->add(cage, isPinned);
  scene->beforeSubstep = [&body, pinned, rest = cage.mesh.nodes, twist, frames = options.frames,
                          offset = scene->offset](double frame, double seconds) mutable {
    twist.turn = kTurn * smoothStep(0.0, kTurningFraction * frames, frame);
    for (const int n : pinned) movePinnedNode(body.m_nodes[n], twist.point(rest[n]) + offset, seconds);
  };
  return scene;
}

}  // namespace tetskin::scenes
