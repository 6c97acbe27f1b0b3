// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Segments through a tet that holds thousands of triangles: the queries find the same as tests of all triangles, but
// test few.
#include "cage_models.h"

#include <tetskin/cage/src/split/segment_queries.h>

#include <numeric>

namespace tetskin::test {
namespace {

using namespace cage_detail;
using Eigen::Vector3d;

constexpr std::size_t kDirections = 500;

struct Direction {
  Vector3d from, along;
};

Vector3d randomPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  const double x = coordinate(random), y = coordinate(random);
  return {x, y, coordinate(random)};
}

/// Segments between random points in and around a model of size 1.
std::vector<Direction> someDirections() {
  std::mt19937 random(7);
  std::vector<Direction> directions;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const Vector3d from = randomPoint(random);
    directions.push_back({from, randomPoint(random) - from});
  }
  return directions;
}

std::vector<std::uint32_t> allTriangles(const Surface& surface) {
  std::vector<std::uint32_t> all(surface.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

Crossing crossingOf(const Surface& surface, std::size_t triangle, const Direction& direction) {
  const auto& [a, b, c] = surface.triangles[triangle];
  return SeenTriangle(surface.points[a] - direction.from, surface.points[b] - direction.from,
                      surface.points[c] - direction.from)
      .crossing(direction.along);
}

/// The first triangle that is crossed, found by testing all of them one by one.
int firstByAll(const Surface& surface, const Direction& direction, bool leaving) {
  int first = -1;
  double nearest = 1.0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Crossing crossing = crossingOf(surface, t, direction);
    if (crossing.leaves != leaving || !(crossing.fraction > 1e-6 && crossing.fraction < nearest)) continue;
    nearest = crossing.fraction;
    first = static_cast<int>(t);
  }
  return first;
}

TEST(SegmentQueries, FindWhatATestOfAllTrianglesFinds) {
  for (const TriangleMesh& mesh : {figurineMesh(60), torusMesh(60), joined(boxMesh({1, 1, 1}), unitSphere(60))}) {
    const Surface surface = prepareSurface(mesh);
    TetMaterial material;
    material.triangles.values = allTriangles(surface);
    material.triangles.starts = {0, static_cast<std::uint32_t>(surface.triangles.size())};
    const LatticeFrame frame;
    const LatticeLinks links{LatticeSet(), LatticeMesh()};
    const SegmentQueries directions(surface, material, frame, links);
    std::size_t met = 0;
    for (const Direction& direction : someDirections()) {
      const int exit = firstByAll(surface, direction, true);
      EXPECT_EQ(directions.firstExit(0, direction.from, direction.along), exit);
      EXPECT_EQ(directions.firstEntry(0, direction.from, direction.along), firstByAll(surface, direction, false));
      met += exit >= 0 ? 1 : 0;
    }
    EXPECT_GT(met, kDirections / 10);
  }
}

}  // namespace
}  // namespace tetskin::test
