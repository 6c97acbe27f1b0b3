// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes in which touching objects are removed: between steps, and within one where Bullet permits it, from an action.
#include <algorithm>

#include "scenes/once.h"
#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr double kBelow = 0.05;  ///< from the body to the object below it, in units of the body's size

/// One event at a third of the run, within a step, and one at two thirds, between steps.
void atThirds(Scene& scene, const std::function<void()>& within, const std::function<void()>& between) {
  const auto once = std::make_shared<Once>(scene.world().bullet());
  const int frames = std::max(scene.options().frames, 3);
  scene.beforeFrame = [=](int frame, const Moved&) {
    if (frame == frames / 3) once->atTheNextStep(within);
    if (frame == 2 * frames / 3) between();
  };
}

}  // namespace

/// A box lies on the body, which lies on a shelf: both are removed, and the body falls on the floor.
std::unique_ptr<Scene> makeObstaclesGo(const Cage& cage, const SceneOptions& options) {
  constexpr double kHalf = 0.1;
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  const double half = kHalf * options.size, away = 0.5 * box.sizes().y() + kBelow * options.size + half;
  scene->addFloor(2 * kBelow + 2 * kHalf);
  btRigidBody& shelf =
      scene->world().addBox(box.center() - Eigen::Vector3d(0, away, 0), {options.size, half, options.size});
  btRigidBody& load = scene->world().addBox(box.center() + Eigen::Vector3d(0, away, 0), {half, half, half}, 0.0,
                                            static_cast<double>(scene->body().getTotalMass()));
  World& world = scene->world();
  atThirds(
      *scene, [&] { world.remove(load); }, [&] { world.remove(shelf); });
  return scene;
}

/// The body itself is removed while it lies on the floor, and keeps its last position: within a step, or, at a
/// harshness of 2, between steps.
std::unique_ptr<Scene> makeBodyGoes(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  scene->addFloor(kBelow);
  const auto leave = [s = scene.get()] { s->world().bullet().removeCollisionObject(&s->body()); };
  const auto stay = [] {};
  if (options.harshness < 2.0) {
    atThirds(*scene, leave, stay);
  } else {
    atThirds(*scene, stay, leave);
  }
  return scene;
}

}  // namespace tetskin::scenes
