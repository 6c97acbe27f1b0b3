// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes with a body and obstacles that are hard to handle in contact.

#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr double kClose = 0.05;  ///< from the body to the object below it, in units of the body's size

std::unique_ptr<Scene> onNothing(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  scene->add(cage);
  return scene;
}

/// A point below the body in its initial position.
Eigen::Vector3d under(const Scene& scene) {
  const Box3 box = boundingBox(nodePositions(scene.body()));
  return {box.center().x(), box.min().y() - kClose * scene.options().size, box.center().z()};
}

/// Throws the body down, at the options' harshness in body lengths per second.
void throwDown(Scene& scene) {
  const double speed = scene.options().harshness * scene.options().size;
  btSoftBody& body = scene.body();
  body.setVelocity(btVector3(0, static_cast<btScalar>(-speed), 0));
  // Implicit steps begin with the velocities at the end of the last one.
  for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_vn = body.m_nodes[n].m_v;
}

}  // namespace

/// The pole is thinner than a tet, and under the centre of the body; the floor is half the body's size below it.
std::unique_ptr<Scene> makePole(const Cage& cage, const SceneOptions& options) {
  constexpr double kRadius = 0.015;
  auto scene = onNothing(cage, options);
  const double radius = kRadius * options.size;
  scene->world().addPole(under(*scene) - Eigen::Vector3d(0, radius, 0), radius, options.size);
  scene->addFloor(0.5);
  throwDown(*scene);
  return scene;
}

/// The body falls on the edge of a thin box that stands upright.
std::unique_ptr<Scene> makeBlade(const Cage& cage, const SceneOptions& options) {
  constexpr double kThick = 0.01, kHalfHeight = 0.2;
  auto scene = onNothing(cage, options);
  const Eigen::Vector3d half = options.size * Eigen::Vector3d(0.5 * kThick, kHalfHeight, 1.0);
  scene->world().addBox(under(*scene) - Eigen::Vector3d(0, half.y(), 0), half);
  scene->addFloor(0.5);
  throwDown(*scene);
  return scene;
}

/// The body falls on a bed of 225 small balls.
std::unique_ptr<Scene> makeBed(const Cage& cage, const SceneOptions& options) {
  constexpr int kAside = 7;
  constexpr double kRadius = 0.05;
  auto scene = onNothing(cage, options);
  const double radius = kRadius * options.size;
  for (int i = -kAside; i <= kAside; ++i) {
    for (int j = -kAside; j <= kAside; ++j) {
      scene->world().addSphere(under(*scene) + radius * Eigen::Vector3d(2 * i, -1, 2 * j), radius);
    }
  }
  scene->addFloor(kClose + 2 * kRadius);
  throwDown(*scene);
  return scene;
}

/// A hundred little boxes, together as heavy as the body, fall on it.
std::unique_ptr<Scene> makeHail(const Cage& cage, const SceneOptions& options) {
  constexpr int kSide = 5, kLayers = 4;
  constexpr double kHalf = 0.03;
  auto scene = onNothing(cage, options);
  scene->addFloor(kClose);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  const double half = kHalf * options.size;
  const double mass = static_cast<double>(scene->body().getTotalMass()) / (kSide * kSide * kLayers);
  for (int k = 0; k < kSide * kSide * kLayers; ++k) {
    const int i = k % kSide - kSide / 2, j = k / kSide % kSide - kSide / 2, layer = k / (kSide * kSide);
    const Eigen::Vector3d at(4 * i * half, (2 + 3 * layer) * half, 3 * j * half);
    scene->world().addBox(Eigen::Vector3d(box.center().x(), box.max().y(), box.center().z()) + at,
                          Eigen::Vector3d::Constant(half), 0.0, mass);
  }
  return scene;
}

/// A box with a tenth of the body's mass falls on it.
std::unique_ptr<Scene> makeLightBox(const Cage& cage, const SceneOptions& options) {
  constexpr double kFraction = 0.1;
  auto scene = onNothing(cage, options);
  scene->addFloor(kClose);
  const Box3 box = boundingBox(nodePositions(scene->body()));
  const double half = 0.15 * options.size;
  Eigen::Vector3d above = box.center();
  above.y() = box.max().y() + kClose * options.size + half;
  scene->world().addBox(above, Eigen::Vector3d::Constant(half), 0.0,
                        kFraction * static_cast<double>(scene->body().getTotalMass()));
  return scene;
}

}  // namespace tetskin::scenes
