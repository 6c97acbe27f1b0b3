// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Ways through a tet that holds thousands of triangles: the same is found as by testing all of them, by testing few.
#include "cage_models.h"

#include <gtest/gtest.h>
#include <tetskin/cage/src/split/body_ways.h>

#include <numeric>
#include <random>

namespace tetskin::test {
namespace {

using cage_detail::BodyWays;
using cage_detail::Crossing;
using cage_detail::LatticeFrame;
using cage_detail::LatticeLinks;
using cage_detail::LatticeMesh;
using cage_detail::LatticeSet;
using cage_detail::prepareSurface;
using cage_detail::SeenTriangle;
using cage_detail::Surface;
using cage_detail::TetMaterial;
using Eigen::Vector3d;

constexpr std::size_t kWays = 500;

struct Way {
  Vector3d from, along;
};

Vector3d randomPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  const double x = coordinate(random), y = coordinate(random);
  return {x, y, coordinate(random)};
}

/// From points about a model of size 1 to others.
std::vector<Way> someWays() {
  std::mt19937 random(7);
  std::vector<Way> ways;
  for (std::size_t k = 0; k < kWays; ++k) {
    const Vector3d from = randomPoint(random);
    ways.push_back({from, randomPoint(random) - from});
  }
  return ways;
}

std::vector<std::uint32_t> allTriangles(const Surface& surface) {
  std::vector<std::uint32_t> all(surface.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

Crossing crossingOf(const Surface& surface, std::size_t triangle, const Way& way) {
  const auto& [a, b, c] = surface.triangles[triangle];
  return SeenTriangle(surface.points[a] - way.from, surface.points[b] - way.from, surface.points[c] - way.from)
      .crossing(way.along);
}

/// All triangles one by one.
int firstByAll(const Surface& surface, const Way& way, bool leaving) {
  int first = -1;
  double nearest = 1.0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Crossing crossing = crossingOf(surface, t, way);
    if (crossing.leaves != leaving || !(crossing.share > 1e-6 && crossing.share < nearest)) continue;
    nearest = crossing.share;
    first = static_cast<int>(t);
  }
  return first;
}

TEST(BodyWays, FindWhatATestOfAllTrianglesFinds) {
  for (const TriangleMesh& mesh : {figurineMesh(60), torusMesh(60), joined(boxMesh({1, 1, 1}), unitSphere(60))}) {
    const Surface surface = prepareSurface(mesh);
    TetMaterial material;
    material.triangles.values = allTriangles(surface);
    material.triangles.starts = {0, static_cast<std::uint32_t>(surface.triangles.size())};
    const LatticeFrame frame;
    const LatticeLinks links{LatticeSet(), LatticeMesh()};
    const BodyWays ways(surface, material, frame, links);
    std::size_t met = 0;
    for (const Way& way : someWays()) {
      const int exit = firstByAll(surface, way, true);
      EXPECT_EQ(ways.firstExit(0, way.from, way.along), exit);
      EXPECT_EQ(ways.firstEntry(0, way.from, way.along), firstByAll(surface, way, false));
      met += exit >= 0 ? 1 : 0;
    }
    EXPECT_GT(met, kWays / 10);
  }
}

}  // namespace
}  // namespace tetskin::test
