// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/distance_grid.h>

#include "contact_test.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;

const Eigen::Vector3d kGridHalf(0.5, 0.3, 0.2);
constexpr int kGridCells = 20;

/// The signed distance from the surface of a box.
double distanceFromBox(const Eigen::Vector3d& p) {
  const Eigen::Vector3d over = p.cwiseAbs() - kGridHalf;
  return over.cwiseMax(0.0).norm() + std::min(over.maxCoeff(), 0.0);
}

DistanceGrid gridOf(const TriangleMesh& mesh) {
  return {TriangleBvh(mesh), WindingTree(mesh), Box3(-kGridHalf, kGridHalf), kGridCells};
}

TEST(DistanceGrid, AtItsCornersIsTheDistanceFromTheBox) {
  const DistanceGrid grid = gridOf(boxMesh(kGridHalf));
  EXPECT_NEAR(grid.spacing(), 1.0 / kGridCells, 1e-7);
  int inside = 0;
  for (int corner = 0; corner < 22 * 14 * 10; ++corner) {
    const Eigen::Vector3d at(corner % 22 - 1, corner / 22 % 14 - 1, corner / 308 - 1);
    // A little beyond the corner: there the cube begins whose values are asked for.
    const Eigen::Vector3d p = at / kGridCells - kGridHalf + Eigen::Vector3d::Constant(1e-6);
    GridDistance found;
    ASSERT_TRUE(grid.at(toBullet(p), found));
    ASSERT_NEAR(found.distance, distanceFromBox(p), 1e-5) << p.transpose();
    inside += found.distance < 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 500);
}

TEST(DistanceGrid, BetweenCornersIsTheMeanByVolumeWithItsGradient) {
  const DistanceGrid grid = gridOf(boxMesh(kGridHalf));
  const double spacing = 1.0 / kGridCells;
  for (const Eigen::Vector3d& p : randomPoints(500, Box3(-1.1 * kGridHalf, 1.1 * kGridHalf), 9)) {
    const Eigen::Vector3d cell = ((p + kGridHalf) / spacing).array().floor(), low = cell * spacing - kGridHalf;
    const Eigen::Vector3d t = (p - low) / spacing;
    double mean = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3d up(c & 1, c >> 1 & 1, c >> 2), side = 2.0 * up - Eigen::Vector3d::Ones();
      const Eigen::Vector3d w = Eigen::Vector3d::Ones() - up + side.cwiseProduct(t);
      const double distance = distanceFromBox(low + spacing * up);
      mean += distance * w.prod();
      gradient += distance / spacing * side.cwiseProduct(Eigen::Vector3d(w.y() * w.z(), w.z() * w.x(), w.x() * w.y()));
    }
    GridDistance found;
    ASSERT_TRUE(grid.at(toBullet(p), found));
    EXPECT_NEAR(found.distance, mean, 1e-5);
    EXPECT_LT((toEigen(found.gradient) - gradient).norm(), 1e-3);
  }
}

TEST(DistanceGrid, OfASurfaceThatFacesInwardsHasNoInside) {
  TriangleMesh box = boxMesh(kGridHalf);
  EXPECT_TRUE(gridOf(box).hasInside());
  for (auto& triangle : box.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_FALSE(gridOf(box).hasInside());
}

TEST(DistanceGrid, KnowsNothingBeyondItsBox) {
  GridDistance at;
  const DistanceGrid grid = gridOf(boxMesh(kGridHalf));
  EXPECT_FALSE(grid.at(btVector3(10, 0, 0), at));
  EXPECT_FALSE(grid.at(btVector3(0, -10, 0), at));
  EXPECT_FALSE(grid.at(btVector3(0, 0, std::numeric_limits<btScalar>::quiet_NaN()), at));
}

}  // namespace
}  // namespace tetskin::test
