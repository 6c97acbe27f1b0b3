// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies that touch each other at the surfaces of their cages. In the classic world they pass through each other.
#include <btBulletDynamicsCommon.h>
#include <tetskin/contact/soft_contacts.h>

#include <algorithm>
#include <cmath>

#include "scenes/angles.h"
#include "scenes/input_error.h"
#include "scenes/once.h"
#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr int kPiled = 4;
constexpr double kGap = 0.05;      ///< between bodies at the start, in units of the body's size
constexpr double kSqueezed = 0.5;  ///< remaining share of the height of the body between two others
constexpr int kSamples = 1500, kCells = 40;

TriangleMesh surfaceOf(const Cage& cage) {
  TriangleMesh mesh;
  mesh.positions = cage.mesh.nodes;
  mesh.triangles = boundaryFaces(cage.mesh);
  return mesh;
}

void collide(Scene& scene, const Cage& cage) {
  if (scene.options().force != Force::Elastic) return;
  ContactShapeOptions options;
  options.sampleCount = kSamples;
  options.gridResolution = kCells;
  const auto shape = ContactShape::create(cage.mesh, surfaceOf(cage), options);
  require(shape.status());
  for (std::size_t b = 0; b < scene.bodyCount(); ++b) scene.world().touchEachOther(scene.body(b), shape.value());
}

double pitchOf(const Cage& cage, const SceneOptions& options) {
  return boundingBox(cage.mesh.nodes).sizes().y() + kGap * options.size;
}

/// Bodies on top of each other, each shifted a little to the side.
std::unique_ptr<Scene> makeStack(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, kEarth);
  for (int k = 0; k < kPiled; ++k) {
    scene->add(cage, {}, {0.1 * options.size * (k % 2), k * pitchOf(cage, options), 0.05 * options.size * (k / 2)});
  }
  scene->addFloor(kGap);
  collide(*scene, cage);
  return scene;
}

}  // namespace

std::unique_ptr<Scene> makeSoftStack(const Cage& cage, const SceneOptions& options) {
  return makeStack(cage, options);
}

/// The second and the last body are removed within a step, from an action.
std::unique_ptr<Scene> makeSoftRemoved(const Cage& cage, const SceneOptions& options) {
  auto scene = makeStack(cage, options);
  const auto once = std::make_shared<Once>(scene->world().bullet());
  const int frames = std::max(options.frames, kPiled);
  scene->beforeFrame = [made = scene.get(), once, frames](int frame, const Moved&) {
    for (int k = 1; k < kPiled; ++k) {
      if (frame != frames * (k + 1) / (kPiled + 1)) continue;
      const auto leave = [made, k] {
        made->world().bullet().removeCollisionObject(&made->body(static_cast<std::size_t>(k)));
      };
      k % 2 ? once->atTheNextStep(leave) : leave();
    }
  };
  return scene;
}

/// Ten bodies between four walls.
std::unique_ptr<Scene> makeSoftPile(const Cage& cage, const SceneOptions& options) {
  constexpr int kBodies = 10, kInALayer = 2;
  constexpr double kWall = 0.7, kAside = 0.6;
  auto scene = std::make_unique<Scene>(options, kEarth);
  const Eigen::Vector3d sizes = boundingBox(cage.mesh.nodes).sizes();
  for (int k = 0; k < kBodies; ++k) {
    const int layer = k / kInALayer, beside = k % kInALayer;
    scene->add(cage, {}, {0.1 * options.size * (layer % 2), layer * 1.2 * sizes.y(), kAside * options.size * beside});
  }
  scene->addFloor(kGap);
  const double wall = kWall * options.size, thick = 0.25 * options.size, high = 3.0 * options.size;
  for (const double side : {-1.0, 1.0}) {
    const double away = side * (wall + thick);
    const double centroid = 0.5 * kAside * options.size;
    scene->world().addBox({away, scene->floorY, centroid}, {thick, high, 2 * wall});
    scene->world().addBox({0, scene->floorY, centroid + away}, {2 * wall, high, thick});
  }
  collide(*scene, cage);
  scene->extent = 4.0;
  return scene;
}

std::unique_ptr<Scene> makeSoftSqueezed(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, 0.0);
  const double pitch = pitchOf(cage, options), direction = kSqueezed * boundingBox(cage.mesh.nodes).sizes().y();
  scene->add(cage);
  const auto everywhere = [](const Eigen::Vector3d&) { return true; };
  for (const double side : {-1.0, 1.0}) scene->add(cage, everywhere, {0, side * pitch, 0});
  collide(*scene, cage);
  Scene* const made = scene.get();
  const int frames = std::max(options.frames, 1);
  // There and back. Each of the two moves by half of the distance by which the body is squeezed.
  scene->beforeSubstep = [made, direction, frames](double frame, double seconds) {
    const double speed = 0.5 * direction * kPi * std::sin(2.0 * kPi * frame / frames) * kFrameRate / frames;
    for (std::size_t b = 1; b < made->bodyCount(); ++b) {
      for (int n = 0; n < made->body(b).m_nodes.size(); ++n) {
        btSoftBody::Node& node = made->body(b).m_nodes[n];
        const Eigen::Vector3d step(0, (b == 1 ? 1.0 : -1.0) * speed * seconds, 0);
        movePinnedNode(node, toEigen(node.m_x) + step, seconds);
      }
    }
  };
  return scene;
}

}  // namespace tetskin::scenes
