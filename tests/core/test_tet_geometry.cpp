// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/mesh/tet_geometry.h>

namespace tetskin {
namespace {

const TetCorners kUnit{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                       Eigen::Vector3d(0, 0, 1)};

TetCorners randomTet(unsigned seed) {
  const auto p = test::randomPoints(4, {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)}, seed);
  return {p[0], p[1], p[2], p[3]};
}

TEST(TetGeometry, VolumeHasASign) {
  EXPECT_DOUBLE_EQ(signedVolume(kUnit), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(signedVolume({kUnit[1], kUnit[0], kUnit[2], kUnit[3]}), -1.0 / 6.0);
}

TEST(TetGeometry, SizeIsTheLongestEdge) {
  EXPECT_DOUBLE_EQ(tetSize(kUnit), std::sqrt(2.0));
}

TEST(TetGeometry, MeanEdgeIsThatOfTheTetsWithAVolume) {
  TetMesh mesh = test::singleTet();
  EXPECT_DOUBLE_EQ(meanEdge(mesh), (1.0 + std::sqrt(2.0)) / 2.0);
  mesh.nodes.insert(mesh.nodes.end(), {{7, 0, 0}, {0, 9, 0}, {7, 9, 0}});
  mesh.tets.push_back({0, 4, 5, 6});  // flat
  EXPECT_DOUBLE_EQ(meanEdge(mesh), (1.0 + std::sqrt(2.0)) / 2.0);
  mesh.tets.push_back({0, 1, 2, 3});  // a duplicate counts again
  mesh.nodes.emplace_back(0, 0, 3);
  mesh.tets.push_back({0, 1, 2, 7});
  EXPECT_DOUBLE_EQ(meanEdge(mesh), (2 * (3 + 3 * std::sqrt(2.0)) + 5 + std::sqrt(2.0) + 2 * std::sqrt(10.0)) / 18);
}

TEST(TetGeometry, TheLargestWeightIsAbsolute) {
  EXPECT_EQ(largestWeight({0.25, 0.25, 0.25, 0.25}), 0.25);
  EXPECT_EQ(largestWeight({-5.0, 4.0, 1.5, 0.5}), 5.0);
}

TEST(TetGeometry, WeightsReproduceThePointAndSumToOne) {
  for (unsigned seed = 1; seed < 200; ++seed) {
    const TetCorners p = randomTet(seed);
    if (isFlat(p)) continue;
    const Eigen::Vector3d v =
        test::randomPoints(1, {Eigen::Vector3d(-2, -2, -2), Eigen::Vector3d(2, 2, 2)}, seed + 999)[0];
    const Eigen::Vector4d b = BarycentricMap(p)(v);
    EXPECT_NEAR(b.sum(), 1.0, 1e-12 * b.cwiseAbs().sum());
    const Eigen::Vector3d back = b[0] * p[0] + b[1] * p[1] + b[2] * p[2] + b[3] * p[3];
    EXPECT_LT((back - v).norm(), 1e-12 * b.cwiseAbs().sum());
  }
}

TEST(TetGeometry, WeightsAtNodesAreUnitVectors) {
  const BarycentricMap map(kUnit);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(map(kUnit[i]), Eigen::Vector4d::Unit(i));
}

TEST(TetGeometry, BarycentricDistanceIsDistanceOverAltitude) {
  const Eigen::Vector4d b = BarycentricMap(kUnit)(Eigen::Vector3d(0.2, 0.2, -0.3));
  EXPECT_DOUBLE_EQ(barycentricDistance(b), 0.3);  // 0.3 below the face opposite a node of altitude 1
  EXPECT_LT(barycentricDistance(BarycentricMap(kUnit)(Eigen::Vector3d(0.2, 0.2, 0.2))), 0.0);
}

TEST(TetGeometry, GradientLengthsAreInverseAltitudes) {
  const Eigen::Vector4d g = BarycentricMap(kUnit).gradientLengths();
  EXPECT_DOUBLE_EQ(g[0], std::sqrt(3.0));  // the origin is 1/sqrt(3) above the slanted face
  for (int i = 1; i < 4; ++i) EXPECT_DOUBLE_EQ(g[i], 1.0);
}

TEST(TetGeometry, DistanceMatchesADenseSampleOfTheTet) {
  for (unsigned seed = 1; seed < 30; ++seed) {
    const TetCorners p = randomTet(seed);
    if (std::abs(signedVolume(p)) < 0.02) continue;
    const Eigen::Vector3d v =
        test::randomPoints(1, {Eigen::Vector3d(-3, -3, -3), Eigen::Vector3d(3, 3, 3)}, seed + 77)[0];
    constexpr int kSteps = 24;
    double sampled = 1e9;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        for (int k = 0; i + j + k <= kSteps; ++k) {
          const Eigen::Vector3d q = (i * p[0] + j * p[1] + k * p[2] + (kSteps - i - j - k) * p[3]) / kSteps;
          sampled = std::min(sampled, (v - q).norm());
        }
      }
    }
    const double distance = distanceToTet(v, p, BarycentricMap(p)(v));
    EXPECT_LE(distance, sampled + 1e-12) << seed;
    EXPECT_GE(distance, sampled - tetSize(p) / kSteps) << seed;
  }
}

TEST(TetGeometry, DistanceIsZeroInsideAndOnTheSurface) {
  const BarycentricMap map(kUnit);
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(0, 0, 0.5), kUnit[2]}) {
    EXPECT_EQ(distanceToTet(v, kUnit, map(v)), 0.0);
  }
}

TEST(ClosestPointInTet, IsAPointOfTheTetFromHoweverFar) {
  // Found by fuzzing: from so far away, a face reduced to a division of zero by zero.
  const TetCorners p = {Eigen::Vector3d(2e-12, 1.5e-12, 1.75e-12), Eigen::Vector3d(1.5e-12, 1.5e-12, 2e-12),
                        Eigen::Vector3d(0.0, 3.75e-12, 3.5e-12), Eigen::Vector3d::Zero()};
  const BarycentricMap map(p);
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  for (const Eigen::Vector3d& v : test::randomPoints(1000, {-one, one}, 41)) {
    const Eigen::Vector3d far = 1e13 * v;
    const double distance = distanceToTet(far, p, map(far));
    EXPECT_NEAR(distance / far.norm(), 1.0, 1e-6);
  }
}

}  // namespace
}  // namespace tetskin
