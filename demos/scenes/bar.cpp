// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/bar.h"

#include <algorithm>
#include <cmath>

#include "scenes/angles.h"
#include "scenes/serpent.h"
#include "scenes/serpent_spine.h"
#include "scenes/serpent_tube.h"

namespace tetskin::scenes {
namespace {

constexpr double kHalfLength = 2.0, kHalfWidth = 0.46;
constexpr double kCapDepth = 0.25;     ///< length over which each end is rounded off
constexpr double kCapFraction = 0.13;  ///< share of the rings, for each end
constexpr double kRidgeHeight = 0.035;
constexpr int kRidges = 16, kColumnsPerRidge = 6;
constexpr double kBarSlenderness = 1.35;

/// Distance of the outline from the axis, relative to half the width: a rounded square.
double outline(double theta) {
  return std::pow(std::pow(std::cos(theta), 4.0) + std::pow(std::sin(theta), 4.0), -0.25);
}

}  // namespace

TriangleMesh makeBar(std::size_t triangles) {
  const std::size_t wish = std::clamp(triangles, kMinSerpentTriangles, kMaxSerpentTriangles);
  const TubeGrid grid = tubeGrid(static_cast<double>(wish), kBarSlenderness);
  const double ridge = grid.columns >= kColumnsPerRidge * kRidges ? kRidgeHeight : 0.0;
  TriangleMesh mesh;
  appendTube(mesh, grid, [&](int ring, int column) -> Eigen::Vector3d {
    const double t = static_cast<double>(ring) / (grid.rings + 1);
    const double end = std::min({t / kCapFraction, (1.0 - t) / kCapFraction, 1.0});  // 0 at a pole, 1 between the caps
    const double inwards = kCapDepth * (1.0 - std::cos(0.5 * kPi * end));
    const double centroid = std::clamp((t - kCapFraction) / (1.0 - 2.0 * kCapFraction), 0.0, 1.0);
    const double between = (2.0 * centroid - 1.0) * (kHalfLength - kCapDepth);
    const double x = end < 1.0 ? (t < 0.5 ? inwards - kHalfLength : kHalfLength - inwards) : between;
    const double theta = 2.0 * kPi * column / grid.columns;
    const double radius =
        kHalfWidth * std::sin(0.5 * kPi * end) * outline(theta) * (1.0 + ridge * std::cos(kRidges * theta));
    return {x, radius * std::cos(theta), radius * std::sin(theta)};
  });
  mesh.groups.push_back({"bar", "bar", 0, mesh.triangleCount()});
  return mesh;
}

}  // namespace tetskin::scenes
