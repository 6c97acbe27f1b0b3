// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes with a body and kinematic obstacles, which move regardless of what is in their way.
#include <algorithm>
#include <cmath>

#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr double kApart = 0.05;        ///< between the body and the moving obstacle, in units of the body's size
constexpr double kThick = 0.1;         ///< half the thickness of plates, in units of the body's size
constexpr double kMoving = 5.0 / 6.0;  ///< share of the run in which obstacles move; then everything stands still

int framesOf(const Scene& scene) {
  constexpr int kFrames = 60;
  return scene.options().frames > 0 ? scene.options().frames : kFrames;
}

/// Two plates, one below and one above the body, move towards each other.
class Press {
 public:
  /// left  remaining share of the body's height when the plates are nearest
  Press(Scene& scene, double left) {
    const double size = scene.options().size;
    const Box3 box = boundingBox(nodePositions(scene.body()));
    centre_ = box.center();
    away_ = 0.5 * box.sizes().y() + (kThick + kApart) * size;
    direction_ = 0.5 * (1.0 - left) * box.sizes().y() + kApart * size;
    for (int k = 0; k < 2; ++k) plates_[k] = &scene.world().addMovingBox(at(k, 0.0), {size, kThick * size, size});
  }
  /// closed  0: apart, 1: nearest
  void close(double closed) {
    for (int k = 0; k < 2; ++k) moveTo(*plates_[k], at(k, closed));
  }

 private:
  Eigen::Vector3d at(int k, double closed) const {
    return centre_ + Eigen::Vector3d(0.0, (k == 0 ? -1.0 : 1.0) * (away_ - closed * direction_), 0.0);
  }

  Eigen::Vector3d centre_;
  double away_, direction_;
  btRigidBody* plates_[2];
};

}  // namespace

/// Squeezes the body to a share of its height, and lets go of it. Without gravity.
std::unique_ptr<Scene> makeFlatten(const Cage& cage, const SceneOptions& options) {
  constexpr double kLeft = 0.1;
  auto scene = std::make_unique<Scene>(options, 0.0);
  scene->add(cage);
  const double left = options.harshness > 0.0 ? options.harshness : kLeft;
  const auto press = std::make_shared<Press>(*scene, left);
  const int frames = framesOf(*scene);
  scene->beforeSubstep = [press, frames](double frame, double) {
    press->close(std::sin(EIGEN_PI * std::min(frame / (0.75 * frames), 1.0)));
  };
  return scene;
}

/// The body is squeezed and let go once per second for most of the run, and then held.
std::unique_ptr<Scene> makeSqueeze(const Cage& cage, const SceneOptions& options) {
  constexpr double kLeft = 0.5, kTurnsPerSecond = 1.0;
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  const double left = options.harshness > 0.0 ? options.harshness : kLeft;
  const auto press = std::make_shared<Press>(*scene, left);
  const double last = std::floor(kMoving * framesOf(*scene) * options.frameSeconds * kTurnsPerSecond) + 0.5;
  scene->beforeSubstep = [press, last, seconds = options.frameSeconds](double frame, double) {
    const double turns = std::min(frame * seconds * kTurnsPerSecond, last);
    press->close(0.5 - 0.5 * std::cos(2.0 * EIGEN_PI * turns));
  };
  return scene;
}

/// A plate presses the body on the floor to half of its height during half of the run, and moves up again.
std::unique_ptr<Scene> makePress(const Cage& cage, const SceneOptions& options) {
  constexpr double kLeft = 0.5;
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  scene->addFloor(0.0);
  const double half = kThick * options.size, top = box.max().y() + half + kApart * options.size;
  const double direction = (1.0 - kLeft) * box.sizes().y() + kApart * options.size;
  const Eigen::Vector3d at(box.center().x(), top, box.center().z());
  btRigidBody& plate = scene->world().addMovingBox(at, {options.size, half, options.size});
  const int frames = framesOf(*scene);
  scene->beforeSubstep = [=, &plate](double frame, double) {
    const double down = std::sin(EIGEN_PI * std::min(frame / frames, 1.0));
    moveTo(plate, at - Eigen::Vector3d(0.0, direction * down, 0.0));
  };
  return scene;
}

/// A bar rotates, once per second by default, and moves to and fro over the body, between four walls. It stops for the
/// last sixth of the run.
std::unique_ptr<Scene> makeMill(const Cage& cage, const SceneOptions& options) {
  constexpr double kTurnsPerSecond = 1.0, kHalfLength = 0.4, kHalfWidth = 0.04, kAbove = 0.5, kAside = 0.5;
  constexpr double kWall = 1.2, kPeriod = 3.7;
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  scene->addFloor(kApart);
  const double size = options.size, thick = 0.25 * size, wall = kWall * size;
  const Eigen::Vector3d centroid(scene->offset.x(), scene->floorY, scene->offset.z());
  for (const double side : {-1.0, 1.0}) {
    scene->world().addBox(centroid + Eigen::Vector3d(side * (wall + thick), 0, 0), {thick, 2 * size, 2 * wall});
    scene->world().addBox(centroid + Eigen::Vector3d(0, 0, side * (wall + thick)), {2 * wall, 2 * size, thick});
  }
  const double turnsPerSecond = options.harshness > 0.0 ? options.harshness : kTurnsPerSecond;
  const auto toPosition = [=](double seconds) {
    return Eigen::Vector3d(centroid + size * Eigen::Vector3d(kAside * std::sin(2.0 * EIGEN_PI * seconds / kPeriod),
                                                             kAbove + 0.4 * std::exp(-4.0 * seconds), 0));
  };
  btRigidBody& bar =
      scene->world().addMovingBox(toPosition(0.0), size * Eigen::Vector3d(kHalfLength, kHalfWidth, 0.8 * kWall));
  const double until = kMoving * framesOf(*scene) * options.frameSeconds;
  scene->beforeSubstep = [=, &bar, seconds = options.frameSeconds](double frame, double) {
    const double now = std::min(frame * seconds, until);
    moveTo(bar, toPosition(now), 2.0 * EIGEN_PI * turnsPerSecond * now);
  };
  return scene;
}

}  // namespace tetskin::scenes
