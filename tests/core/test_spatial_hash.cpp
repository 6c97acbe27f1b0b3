// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/src/search/spatial_hash.h>

#include <set>

namespace tetskin {
namespace {

const Box3 kUnitBox(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());

struct Found {
  std::set<std::uint32_t> points;
  std::size_t visited = 0;
};

SpatialHash hashOf(const std::vector<Eigen::Vector3d>& points, double cellSize, std::size_t tableSize = 0) {
  return SpatialHash(viewOf(points), boundingBox(points), cellSize, {}, tableSize);
}

Found query(const SpatialHash& hash, const Box3& box) {
  Found found;
  hash.query(box, [&](std::uint32_t first, std::uint32_t last) {
    EXPECT_LT(first, last);
    EXPECT_LE(last, hash.size());
    found.visited += last - first;
    for (; first < last; ++first) EXPECT_TRUE(found.points.insert(hash.ids()[first]).second) << "visited twice";
  });
  return found;
}

void expectCovers(const SpatialHash& hash, const std::vector<Eigen::Vector3d>& points, const Box3& box) {
  const Found found = query(hash, box);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (box.contains(points[i])) {
      ASSERT_EQ(found.points.count(i), 1u) << "point " << i;
    }
  }
}

std::vector<Box3> someBoxes(const Box3& around, unsigned seed) {
  const auto corners = test::randomPoints(80, around, seed);
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i + 1 < corners.size(); i += 2) {
    Box3 box(corners[i]);
    boxes.push_back(box.extend(corners[i] + 0.2 * (corners[i + 1] - corners[i])));
  }
  return boxes;
}

TEST(SpatialHash, OfNothingFindsNothing) {
  const SpatialHash hash = hashOf({}, 1.0);
  EXPECT_EQ(query(hash, kUnitBox).visited, 0u);
}

TEST(SpatialHash, EmptyBoxFindsNothing) {
  const SpatialHash hash = hashOf({Eigen::Vector3d::Zero()}, 1.0);
  EXPECT_EQ(query(hash, Box3()).visited, 0u);
}

TEST(SpatialHash, HoldsEveryPointOnceInTableOrder) {
  const auto points = test::randomPoints(1000, kUnitBox, 1);
  const SpatialHash hash = hashOf(points, 0.1);
  ASSERT_EQ(hash.size(), points.size());
  std::set<std::uint32_t> ids(hash.ids(), hash.ids() + hash.size());
  EXPECT_EQ(ids.size(), points.size());
  for (std::size_t e = 0; e < hash.size(); ++e) {
    const Eigen::Vector3d inFrame = (points[hash.ids()[e]] - hash.frame().centre) * hash.frame().scale;
    EXPECT_LE(inFrame.cwiseAbs().maxCoeff(), 1.0 + 1e-12);
    EXPECT_EQ(Eigen::Vector3f(hash.x()[e], hash.y()[e], hash.z()[e]), Eigen::Vector3f(inFrame.cast<float>()));
  }
}

TEST(SpatialHash, FindsAllPointsInABox) {
  const auto points = test::randomPoints(2000, kUnitBox, 2);
  const SpatialHash hash = hashOf(points, 0.07);
  for (const Box3& box : someBoxes(kUnitBox, 3)) expectCovers(hash, points, box);
}

TEST(SpatialHash, FindsAllPointsWithATableForcedToCollide) {
  const auto points = test::randomPoints(500, kUnitBox, 4);
  for (const std::size_t tableSize : {1, 2, 8}) {
    const SpatialHash hash = hashOf(points, 0.05, tableSize);
    EXPECT_LE(hash.tableSize(), tableSize);
    for (const Box3& box : someBoxes(kUnitBox, 5)) expectCovers(hash, points, box);
  }
}

TEST(SpatialHash, WorksWithNegativeAndHugeCoordinates) {
  for (const double offset : {-1e6, 1e6, -1e12}) {
    const Box3 around(Eigen::Vector3d::Constant(offset), Eigen::Vector3d::Constant(offset + 1.0));
    const auto points = test::randomPoints(500, around, 6);
    const SpatialHash hash = hashOf(points, 0.1);
    for (const Box3& box : someBoxes(around, 7)) expectCovers(hash, points, box);
  }
}

TEST(SpatialHash, FindsPointsAtTheEdgeOfTheRepresentable) {
  const std::vector<Eigen::Vector3d> points{{1e29, 0, 0}, {-1e29, 1e29, 3}, {0, 0, 0}};
  const SpatialHash hash = hashOf(points, 1e-3);
  EXPECT_EQ(query(hash, Box3(Eigen::Vector3d::Constant(-1e30), Eigen::Vector3d::Constant(1e30))).points.size(), 3u);
  EXPECT_EQ(query(hash, Box3(points[0], points[0])).points.count(0), 1u);
}

TEST(SpatialHash, MemoryIsProportionalToThePointsHoweverFarApart) {
  auto points = test::randomPoints(1000, kUnitBox, 8);
  points.emplace_back(1e7, -1e7, 1e7);
  const SpatialHash hash = hashOf(points, 0.01);
  EXPECT_LE(hash.tableSize(), 8u * points.size());
  EXPECT_EQ(query(hash, Box3(points.back(), points.back())).points.count(1000), 1u);
}

TEST(SpatialHash, SmallBoxVisitsFewPoints) {
  const auto points = test::randomPoints(20000, kUnitBox, 9);
  const SpatialHash hash = hashOf(points, 0.05);
  const std::size_t visited =
      query(hash, Box3(Eigen::Vector3d::Constant(0.41), Eigen::Vector3d::Constant(0.44))).visited;
  EXPECT_LT(visited, 40u);  // a cell holds 2.5 points on average; the rest are hash collisions
}

TEST(SpatialHash, BoxOfManyRowsVisitsEveryPointOnce) {
  const auto points = test::randomPoints(300, kUnitBox, 10);
  const SpatialHash hash = hashOf(points, 1e-4);
  const Found found = query(hash, kUnitBox);
  EXPECT_EQ(found.points.size(), 300u);
  EXPECT_EQ(found.visited, 300u);
}

}  // namespace
}  // namespace tetskin
