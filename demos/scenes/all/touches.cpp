// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes of a body and obstacles that are hard to meet.
#include <cmath>

#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr double kClose = 0.05;  ///< sizes: from the body to what is below it

std::unique_ptr<Scene> onNothing(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  return scene;
}

}  // namespace

/// Thinner than a tet, under the middle of the body; the floor is half a size below.
std::unique_ptr<Scene> makePole(const Cage& cage, const SceneOptions& options) {
  constexpr double kRadius = 0.015;
  auto scene = onNothing(cage, options);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  const double radius = kRadius * options.size;
  Eigen::Vector3d below = box.center();
  below.y() = box.min().y() - kClose * options.size - radius;
  scene->world().addPole(below, radius, options.size);
  scene->addFloor(0.5);
  return scene;
}

/// Down to half of the body's height in half of the run, and up again.
std::unique_ptr<Scene> makePress(const Cage& cage, const SceneOptions& options) {
  constexpr double kLeft = 0.5;
  auto scene = onNothing(cage, options);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  scene->addFloor(0.0);
  const double half = 0.1 * options.size, top = box.max().y() + half + kClose * options.size;
  const double way = (1.0 - kLeft) * box.sizes().y() + kClose * options.size;
  const Eigen::Vector3d at(box.center().x(), top, box.center().z());
  btRigidBody& plate = scene->world().addMovingBox(at, {options.size, half, options.size});
  const int frames = options.frames > 0 ? options.frames : 60;
  scene->beforeSubstep = [=, &plate](double frame, double) {
    const double down = std::sin(EIGEN_PI * std::min(frame / frames, 1.0));
    moveTo(plate, at - Eigen::Vector3d(0.0, way * down, 0.0));
  };
  return scene;
}

/// A tenth of the body's mass falls on it.
std::unique_ptr<Scene> makeLightBox(const Cage& cage, const SceneOptions& options) {
  constexpr double kShare = 0.1;
  auto scene = onNothing(cage, options);
  scene->addFloor(kClose);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  const double half = 0.15 * options.size;
  Eigen::Vector3d above = box.center();
  above.y() = box.max().y() + kClose * options.size + half;
  scene->world().addBox(above, Eigen::Vector3d::Constant(half), 0.0,
                        kShare * static_cast<double>(scene->body().getTotalMass()));
  return scene;
}

}  // namespace tetskin::scenes
