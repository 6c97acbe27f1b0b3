// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <utility>

#include "pile/pile.h"
#include "scenes/caged_mesh.h"
#include "scenes/solid_meshes.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

// Metres.

constexpr double kCubeHalf = 0.2;
constexpr int kCubeDivisions = 10;

constexpr int kInRow = 4, kInLayer = kInRow * kInRow;
/// Distances between places in a layer and between layers. In each layer every other place is higher by half the
/// latter, so that cubes do not overlap, however they are turned.
constexpr double kPlace = 0.6, kCubeLayer = 0.7;
/// The centre of the lowest cubes.
constexpr double kLowest = 0.4;

/// Half of the bin's inner side, which the outermost cubes do not reach in any rotation; and half of a wall's
/// thickness.
constexpr double kInside = 1.25, kWallHalf = 0.1;

double heightOfLayer(int layer) {
  return kLowest + kCubeLayer * layer;
}

/// Walls around the bodies' heap, with room for those that bounce.
double wallHeight(int bodies) {
  return 1.0 + 0.5 * heightOfLayer((bodies - 1) / kInLayer);
}

void addBin(World& world, double height) {
  const double centre = kInside + kWallHalf;
  world.addBox({0, -0.25, 0}, {3.0, 0.25, 3.0});
  for (const double sign : {-1.0, 1.0}) {
    world.addBox({sign * centre, 0.5 * height, 0}, {kWallHalf, 0.5 * height, kInside});
    world.paint("wall");
    world.addBox({0, 0.5 * height, sign * centre}, {kInside + 2.0 * kWallHalf, 0.5 * height, kWallHalf});
    world.paint("wall");
  }
}

PileModel cubeOf(const PileOptions& options) {
  Model cube;
  cube.name = "cube";
  cube.mesh = boxOfGrids(Vector3d::Constant(kCubeHalf), kCubeDivisions);
  cube.mesh.groups = {{"cube", "cube", 0, cube.mesh.triangleCount()}};
  announceCage(options.model.tets, options.model);
  cube.cage = builtCage(cube.mesh, options.model.tets);
  PileModel model(std::move(cube), SoftBodyOptions{}, true);
  model.contact.emplace();
  return model;
}

/// Centre of the k-th cube before it falls.
Vector3d placeInBin(int k) {
  const int x = k % kInRow, z = k / kInRow % kInRow;
  const double middle = 0.5 * (kInRow - 1), raised = (x + z) % 2 ? 0.5 * kCubeLayer : 0.0;
  return {kPlace * (x - middle), heightOfLayer(k / kInLayer) + raised, kPlace * (z - middle)};
}

}  // namespace

void buildBin(const PileOptions& options, Pile& pile) {
  const double height = wallHeight(options.bodies);
  addBin(pile.world(), height);
  const std::size_t cube = pile.addModel(cubeOf(options));
  for (int k = 0; k < options.bodies; ++k) pile.addBody(cube, placeInBin(k), turnOf(options.seed, k));
  pile.setFocus({Vector3d(-kInside, 0, -kInside), Vector3d(kInside, height, kInside)});
}

}  // namespace tetskin::scenes
