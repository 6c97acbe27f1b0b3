// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/scene_setup.h"

#include <array>

#include "scenes/serpent_spine.h"
#include "scenes/twist_scene.h"

namespace tetskin::report {
namespace {

constexpr double kEarth = 9.81;
/// Shares of the height that are held: the lower end, as if it stood in the ground, and the upper end.
constexpr double kFootShare = 0.35, kTopShare = 0.2;
/// Of the moved end against the other, radians.
constexpr double kTurn = 1.5;
/// Height of the lowest vertex over the box: it is hit after a third of a second.
constexpr double kDropHeight = 0.5;
constexpr int kSagFrames = 60, kTwistFrames = 60, kDropFrames = 48;
/// Share of the frames in which the end is turned; then it is held.
constexpr double kTurningShare = 0.75;

}  // namespace

std::string nameOf(SceneKind kind) {
  constexpr std::array<const char*, 4> kNames = {"sag", "twist", "drop", "exact"};
  return kNames[static_cast<std::size_t>(kind)];
}

TriangleMesh placed(TriangleMesh mesh) {
  const Box3 box = boundingBox(mesh.positions);
  const double scale = kSize / box.sizes().maxCoeff();
  const Eigen::Vector3d centre = box.center();
  for (Eigen::Vector3d& p : mesh.positions) p = scale * (p - centre);
  return mesh;
}

double SceneSetup::turnAt(double frame) const {
  return kTurn * scenes::smoothStep(0.0, kTurningShare * frames, frame);
}

SceneSetup setupOf(SceneKind kind, const TriangleMesh& mesh, int frames) {
  const Box3 box = boundingBox(mesh.positions);
  const Eigen::Vector3d sides = box.sizes();
  SceneSetup setup;
  setup.kind = kind;
  const int up = 1;
  const double foot = box.min()[up] + kFootShare * sides[up];
  if (kind == SceneKind::Sag) {
    setup.held = [=](const Eigen::Vector3d& p) { return p[up] <= foot; };
    setup.frames = kSagFrames;
    setup.gravity = kEarth;
  } else if (kind == SceneKind::Twist) {
    scenes::Twist twist = scenes::twistOf(box, 0.0);
    twist.axis = up;
    twist.from = foot;
    twist.to = box.max()[up] - kTopShare * sides[up];
    setup.held = [twist](const Eigen::Vector3d& p) { return p[up] <= twist.from || p[up] >= twist.to; };
    setup.twist = twist;
    setup.frames = kTwistFrames;
  } else if (kind == SceneKind::Drop) {
    setup.frames = kDropFrames;
    setup.gravity = kEarth;
    setup.floor = true;
    setup.floorY = box.min().y() - kDropHeight;
  } else {
    // Smooth beyond the mesh as well: cages are larger.
    scenes::Twist twist = scenes::twistOf(box, 3.0 * kTurn);
    twist.from -= sides[twist.axis];
    twist.to += sides[twist.axis];
    setup.twist = twist;
    setup.frames = 1;
  }
  if (frames > 0 && kind != SceneKind::Exact) setup.frames = frames;
  return setup;
}

}  // namespace tetskin::report
