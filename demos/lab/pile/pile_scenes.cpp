// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "pile/pile_scenes.h"

#include <algorithm>
#include <cassert>
#include <random>

namespace tetskin::scenes {
namespace {

/// Of the scene "heap": 330,000 vertices in all.
constexpr int kHeapBodies = 26;
constexpr std::size_t kHeapTriangles = 24700;

}  // namespace

const std::vector<PileScene>& pileScenes() {
  static const std::vector<PileScene> scenes = {
      {"column", "pile", "body", "bowl", 100, false, PileFigures::Depths, buildColumn},
      {"heap", "pile", "body", "bowl", 100, false, PileFigures::Depths, buildHeap},
      {"pit", "ball pit", "ball", "balls", 1000, true, PileFigures::Rest, buildPit},
      {"bin", "bin of cubes", "cube", "bin", 1000, true, PileFigures::Rest, buildBin}};
  return scenes;
}

const PileScene& pileSceneNamed(const std::string& name) {
  const auto& all = pileScenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const PileScene& scene) { return name == scene.name; });
  assert(found != all.end());
  return *found;
}

PileOptions presetOf(const std::string& scene) {
  PileOptions options;
  options.scene = scene;
  options.model.tets = 500;
  options.model.triangles = 20000;
  if (scene == "heap") {
    options.bodies = kHeapBodies;
    options.model.triangles = kHeapTriangles;
    options.model.calibrate = true;
  } else if (scene == "pit") {
    options.bodies = 100;
    options.model.tets = 3000;
  } else if (scene == "bin") {
    options.bodies = 50;
    options.model.tets = 100;
  }
  // A box cannot fold onto itself.
  if (pileSceneNamed(scene).ownMeshes) options.selfContact = SelfContactWish::Off;
  return options;
}

Eigen::Quaterniond turnOf(int seed, int k) {
  if (seed == 1) return Eigen::Quaterniond(Eigen::AngleAxisd(1.1 * k, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()));
  std::seed_seq numbers{seed, k};
  std::mt19937 random(numbers);
  Eigen::Vector4d turn;
  do {
    for (double& part : turn) part = 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1.0;
  } while (turn.norm() < 0.1 || turn.norm() > 1.0);  // uniform among all rotations
  return Eigen::Quaterniond(turn.normalized());
}

}  // namespace tetskin::scenes
