// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "pile/pile.h"
#include "scenes/caged_mesh.h"
#include "scenes/solid_meshes.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

// Metres and kilograms.

const Vector3d kMatHalf(2.0, 0.2, 2.0);
/// Squares of 5 cm, half of a ball's radius, so that dents are drawn round.
constexpr int kMatDivisions = 80;
/// Side of the mat's chequers, which show how it is deformed.
constexpr double kChequer = 0.4;
/// Spacing of the mat's contact samples: as its vertices.
constexpr double kMatSpacing = 0.05;
/// The mat starts this far above the floor, somewhat more than contact keeps them apart.
constexpr double kMatLift = 0.01;

constexpr PileBall kLight{0.1, 1.0, "ball", 2};
/// Cast iron, so that the mat visibly gives way beneath it.
constexpr PileBall kHeavy{0.3, 800.0, "heavy_ball", 3};
constexpr int kMostHeavy = 2;
/// The start of heavy balls, beside the middle, and the height of their fall.
constexpr double kHeavyX = 0.8, kHeavyZ = 0.5, kHeavyFall = 0.1;

/// Light balls start above the heavy ones, in layers of at most this many in a row.
constexpr int kMostInRow = 15;
constexpr double kGridSide = 3.6, kGridLayer = 0.3, kGridAbove = kHeavyFall + 2.0 * kHeavy.radius + 2.0 * kLight.radius;
/// Greatest offset of a ball from its place on the grid, so that none lies exactly above another.
constexpr double kOffset = 0.015;

/// Between the mat and each wall, less than a ball is wide; and from the mat's upper side to theirs.
constexpr double kWallGap = 0.05, kWallAbove = 0.4, kWallThick = 0.1;

double topOfMat() {
  return kMatLift + 2.0 * kMatHalf.y();
}

/// A floor inside four low walls.
void addPit(World& world) {
  const double side = kMatHalf.x() + kWallGap + kWallThick, height = 0.5 * (topOfMat() + kWallAbove);
  world.addBox({0, -0.25, 0}, {3.0, 0.25, 3.0});
  for (const double sign : {-1.0, 1.0}) {
    world.addBox({sign * side, height, 0}, {kWallThick, height, side - kWallThick});
    world.paint("wall");
    world.addBox({0, height, sign * side}, {side + kWallThick, height, kWallThick});
    world.paint("wall");
  }
}

/// Makes two groups of the mat's triangles, of two colours.
void paintChequers(TriangleMesh& mat) {
  const auto isLight = [&](const std::array<int, 3>& t) {
    const Vector3d centroid = (mat.positions[t[0]] + mat.positions[t[1]] + mat.positions[t[2]]) / 3.0;
    const Vector3d square = ((centroid + kMatHalf) / kChequer).array().floor();
    return static_cast<int>(square.x() + square.z()) % 2 == 0;
  };
  const auto dark = std::stable_partition(mat.triangles.begin(), mat.triangles.end(), isLight);
  const auto light = static_cast<std::size_t>(dark - mat.triangles.begin());
  mat.groups = {{"mat", "mat", 0, light}, {"mat", "mat_chequer", light, mat.triangleCount() - light}};
}

PileModel matOf(const PileOptions& options) {
  Model mat;
  mat.name = "mat";
  mat.mesh = boxOfGrids(kMatHalf, kMatDivisions);
  paintChequers(mat.mesh);
  announceCage(options.model.tets, options.model);
  mat.cage = builtCage(mat.mesh, options.model.tets);
  PileModel model(std::move(mat), SoftBodyOptions{}, options.touchThemselves());
  model.contact.emplace().sampleSpacing = kMatSpacing;
  return model;
}

/// The k-th light ball's place in a grid of this many in a row, with a small offset that depends on the seed.
Vector3d placeOnGrid(int k, int row, int seed) {
  std::seed_seq numbers{seed, k};
  std::mt19937 random(numbers);
  const auto offset = [&] { return kOffset * (2.0 * static_cast<double>(random()) / std::mt19937::max() - 1.0); };
  const auto along = [&](int place) { return kGridSide * ((place + 0.5) / row - 0.5) + offset(); };
  const double x = along(k % row), z = along(k / row % row);
  return {x, topOfMat() + kGridAbove + kGridLayer * (k / (row * row)), z};
}

}  // namespace

void buildPit(const PileOptions& options, Pile& pile) {
  addPit(pile.world());
  pile.addBody(pile.addModel(matOf(options)), {0, kMatLift + kMatHalf.y(), 0}, Eigen::Quaterniond::Identity());
  const int heavy = std::min(kMostHeavy, options.bodies / 2), light = options.bodies - heavy;
  for (int k = 0; k < heavy; ++k) {
    const double side = k % 2 ? -1.0 : 1.0;
    pile.addBall(kHeavy, {side * kHeavyX, topOfMat() + kHeavyFall + kHeavy.radius, side * kHeavyZ});
  }
  const int row = std::min(static_cast<int>(std::ceil(std::sqrt(light))), kMostInRow);
  for (int k = 0; k < light; ++k) pile.addBall(kLight, placeOnGrid(k, row, options.seed));
  pile.setTop(topOfMat());
  pile.setFocus({-kMatHalf - Vector3d::UnitY() * 0.2, kMatHalf + Vector3d::UnitY()});
}

}  // namespace tetskin::scenes
