// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/twist.h"

#include "scenes/serpent_spine.h"
#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

/// Shares of the height that are held: the lower end, as if it stood in the ground, and the upper end.
constexpr double kFootShare = 0.35, kTopShare = 0.2;
/// Of the moved end against the other, radians.
constexpr double kTurn = 1.5;
/// Share of the frames in which the end is turned; then it is held.
constexpr double kTurningShare = 0.75;

}  // namespace

std::unique_ptr<Scene> makeTwist(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, 0.0);
  const Box3 box = layoutBox(options, cage);
  Twist twist = twistOf(box, 0.0);
  twist.axis = 1;
  twist.from = box.min().y() + kFootShare * box.sizes().y();
  twist.to = box.max().y() - kTopShare * box.sizes().y();
  const auto isHeld = [=](const Eigen::Vector3d& p) { return p.y() <= twist.from || p.y() >= twist.to; };
  const std::vector<int> held = nodesWhere(cage, isHeld);
  btSoftBody& body = scene->add(cage, isHeld);
  scene->beforeSubstep = [&body, held, rest = cage.nodes, twist, frames = options.frames, offset = scene->offset](
                             double frame, double seconds) mutable {
    twist.turn = kTurn * smoothStep(0.0, kTurningShare * frames, frame);
    for (const int n : held) moveHeldNode(body.m_nodes[n], twist.point(rest[n]) + offset, seconds);
  };
  return scene;
}

}  // namespace tetskin::scenes
