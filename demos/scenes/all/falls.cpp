// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes in which a body is above a floor.
#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr double kNear = 0.05;  ///< from the body to the floor, and to the box above it, in units of the body's size

std::unique_ptr<Scene> makeFall(const Cage& cage, const SceneOptions& options, double gap) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  scene->addFloor(gap);
  return scene;
}

}  // namespace

/// The floor is hit after a third of a second.
std::unique_ptr<Scene> makeDrop(const Cage& cage, const SceneOptions& options) {
  return makeFall(cage, options, 0.25);
}

std::unique_ptr<Scene> makeLand(const Cage& cage, const SceneOptions& options) {
  return makeFall(cage, options, kNear);
}

std::unique_ptr<Scene> makeImpact(const Cage& cage, const SceneOptions& options) {
  constexpr double kLengths = 100.0;  // body lengths per second
  auto scene = makeFall(cage, options, kNear);
  const double lengths = options.harshness > 0.0 ? options.harshness : kLengths;
  scene->beforeFrame = [s = scene.get(), lengths](int frame, const Moved&) {
    if (frame != eventFrame(s->options())) return;
    s->body().setVelocity(btVector3(0, static_cast<btScalar>(-lengths * s->options().size), 0));
  };
  return scene;
}

std::unique_ptr<Scene> makeHeavyBox(const Cage& cage, const SceneOptions& options) {
  constexpr double kMass = 1000.0;  // relative to the body's mass
  const double mass = options.harshness > 0.0 ? options.harshness : kMass;
  auto scene = makeFall(cage, options, kNear);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  const double half = 0.5 * options.size;
  Eigen::Vector3d above = box.center();
  above.y() = box.max().y() + kNear * options.size + half;
  scene->world().addBox(above, Eigen::Vector3d::Constant(half), 0.0,
                        mass * static_cast<double>(scene->body().getTotalMass()));
  return scene;
}

}  // namespace tetskin::scenes
