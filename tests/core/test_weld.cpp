// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/mesh/weld.h>

namespace tetskin {
namespace {

std::vector<std::uint32_t> weld(const std::vector<Eigen::Vector3d>& points) {
  return weldCoincident(viewOf(points));
}

TEST(Weld, NothingGivesNothing) {
  EXPECT_TRUE(weld({}).empty());
}

TEST(Weld, NamesTheFirstPointAtEachPosition) {
  EXPECT_EQ(weld({{1, 2, 3}, {4, 5, 6}, {1, 2, 3}, {1, 2, 4}, {4, 5, 6}}), (std::vector<std::uint32_t>{0, 1, 0, 3, 1}));
}

TEST(Weld, TreatsBothZerosAlike) {
  EXPECT_EQ(weld({{0.0, 1, 0}, {-0.0, 1, -0.0}}), (std::vector<std::uint32_t>{0, 0}));
}

TEST(Weld, KeepsNeighboursInTheLastBitApart) {
  const double next = std::nextafter(1.0, 2.0);
  EXPECT_EQ(weld({{1, 1, 1}, {next, 1, 1}, {1, next, 1}}), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Weld, MatchesAllPairsOnManyRepeatedPoints) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p :
       test::randomPoints(2000, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(6)}, 5)) {
    points.emplace_back(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  }
  const auto first = weld(points);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint32_t expected = 0;
    while (points[expected] != points[i]) ++expected;
    ASSERT_EQ(first[i], expected);
  }
}

}  // namespace
}  // namespace tetskin
