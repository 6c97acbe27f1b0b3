// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <array>
#include <utility>

#include "pile/pile.h"
#include "scenes/caged_mesh.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr std::array<BuiltIn, 3> kModels = {BuiltIn::Serpent, BuiltIn::Hand, BuiltIn::Bar};
/// Lengths in the world; the largest side of each body is kSize.
constexpr double kApart = 1.1 * kSize, kFloorY = 0.0, kSide = 1.1 * kSize, kPole = 0.02 * kSize;

/// A floor inside four walls, two of which lean outwards.
void addBowl(World& world) {
  const double height = kSize, thick = 0.25 * kSize;
  world.addBox({0, kFloorY - thick, 0}, {4 * kSide, thick, 4 * kSide});
  for (const double side : {-1.0, 1.0}) {
    world.addBox({side * (kSide + thick + 0.35 * height), 0.5 * height, 0}, {thick, height, kSide}, -side * 0.45);
    world.paint("wall");
    world.addBox({0, 0.5 * height, side * (kSide + thick)}, {2 * kSide, height, thick});
    world.paint("wall");
  }
}

/// Two poles across the bowl.
void addPoles(World& world) {
  for (const double side : {-1.0, 1.0}) {
    world.addBox({side * 0.45 * kSize, 1.6 * kSize, 0}, {kPole, kPole, kSide});
    world.paint("pole");
  }
}

/// Centre of the k-th body before it falls: above the one before.
Vector3d placeInColumn(int k) {
  return {0.12 * kSize * (k % 2 ? 1 : -1), kFloorY + 2.4 * kSize + kApart * k, 0.1 * kSize * (k / 2 % 2)};
}

/// In layers of four.
Vector3d placeInHeap(int k) {
  const double half = 0.5 * kApart;
  return {k % 2 ? half : -half, kFloorY + kSize + kApart * (k / 4), k / 2 % 2 ? half : -half};
}

/// The user's model, or all built-in ones. Returns how many there are.
int addModels(const PileOptions& options, Pile& pile) {
  const auto add = [&](const ModelOptions& wanted) {
    Model model = loadModel(wanted);
    putInWorld(model.mesh, model.cage);
    (void)pile.addModel(PileModel(std::move(model), oneKilogram(), true));
  };
  ModelOptions model = options.model;
  if (!model.mesh.empty()) {
    add(model);
    return 1;
  }
  for (const BuiltIn builtIn : kModels) {
    model.builtIn = builtIn;
    add(model);
  }
  return static_cast<int>(kModels.size());
}

void buildBowl(const PileOptions& options, Pile& pile, bool poles, Vector3d (*place)(int k)) {
  const int models = addModels(options, pile);
  addBowl(pile.world());
  if (poles) addPoles(pile.world());
  for (int k = 0; k < options.bodies; ++k) {
    pile.addBody(static_cast<std::size_t>(k % models), place(k), turnOf(options.seed, k));
  }
  pile.setFocus({Vector3d(-1.5 * kSide, kFloorY, -kSide), Vector3d(1.5 * kSide, kFloorY + 2.0 * kSize, kSide)});
}

}  // namespace

void buildColumn(const PileOptions& options, Pile& pile) {
  buildBowl(options, pile, true, placeInColumn);
}

void buildHeap(const PileOptions& options, Pile& pile) {
  buildBowl(options, pile, false, placeInHeap);
}

}  // namespace tetskin::scenes
