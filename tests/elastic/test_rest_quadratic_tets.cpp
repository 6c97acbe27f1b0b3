// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/elastic/src/tets/rest_quadratic_tets.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace tetskin::elastic_detail {
namespace {

/// A tet of no symmetry, as a cage of one quadratic tet.
Cage oneTet() {
  TetMesh mesh;
  mesh.nodes = {{0.1, 0.2, -0.1}, {1.3, 0.1, 0.2}, {0.3, 1.1, 0.1}, {0.2, 0.4, 1.4}};
  mesh.tets = {{0, 1, 2, 3}};
  return refineQuadratic(mesh).value();
}

RestQuadraticTet restOf(const Cage& cage, const std::vector<double>& scale = {}) {
  return restQuadraticTets(cage, quadraticTets(cage).value(), scale).at(0);
}

/// The integral over the points of a function of the barycentric weights 1 to 3.
double byPoints(const RestQuadraticTet& rest, const std::function<double(const Eigen::Vector3d&)>& f) {
  double sum = 0.0;
  for (std::size_t q = 0; q < kQuadraticPoints; ++q) sum += f(Eigen::Vector3d::Map(&rest.points[3 * q]));
  return sum * rest.volume / kQuadraticPoints;
}

/// The same over the cells of a cage, with a factor per cell: by enough points in each for exact quadratics.
double byCells(const Cage& cage, const std::function<double(std::size_t cell)>& factor,
               const std::function<double(const Eigen::Vector3d&)>& f) {
  const QuadraticTet tet = quadraticTets(cage).value().at(0);
  const BarycentricMap map(cornersOf(cage.mesh, {tet.nodes[0], tet.nodes[1], tet.nodes[2], tet.nodes[3]}));
  double sum = 0.0;
  std::size_t cell = 0;
  for (const Tet& part : cage.mesh.tets) {
    for (const TetCorners& piece : refinedTet(cornersOf(cage.mesh, part))) {
      for (const TetCorners& corners : refinedTet(piece)) {
        for (int k = 0; k < 4; ++k) {
          constexpr double kNear = 0.5854101966249685, kFar = 0.1381966011250105;
          Eigen::Vector3d p = Eigen::Vector3d::Zero();
          for (int i = 0; i < 4; ++i) p += (i == k ? kNear : kFar) * corners[i];
          sum += factor(cell) * std::abs(signedVolume(corners)) / 4.0 * f(map(p).tail<3>());
        }
        ++cell;
      }
    }
  }
  return sum;
}

const std::vector<std::function<double(const Eigen::Vector3d&)>>& quadratics() {
  using V = Eigen::Vector3d;
  static const std::vector<std::function<double(const V&)>> all = {
      [](const V&) { return 1.0; },
      [](const V& p) { return p.x(); },
      [](const V& p) { return p.y(); },
      [](const V& p) { return p.z() * p.z(); },
      [](const V& p) { return p.x() * p.y(); },
      [](const V& p) { return (1.0 - p.sum()) * p.z() + p.x() * p.x(); }};
  return all;
}

TEST(RestQuadraticTets, AreIntegratedExactlyUpToSquares) {
  const Cage cage = oneTet();
  const RestQuadraticTet rest = restOf(cage);
  for (const auto& f : quadratics()) {
    EXPECT_NEAR(byPoints(rest, f),
                byCells(
                    cage, [](std::size_t) { return 1.0; }, f),
                1e-14);
  }
  // A full tet is integrated by the usual rule: (5 - sqrt 5) / 20, and for one weight the rest to 1.
  const double far = (5.0 - std::sqrt(5.0)) / 20.0;
  for (std::size_t q = 0; q < kQuadraticPoints; ++q) {
    const Eigen::Vector3d p = Eigen::Vector3d::Map(&rest.points[3 * q]);
    const Eigen::Vector4d weights(1.0 - p.sum(), p.x(), p.y(), p.z());
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(weights[k], k == static_cast<int>(q) ? 1.0 - 3.0 * far : far, 1e-14) << q << " " << k;
    }
  }
}

TEST(RestQuadraticTets, AreIntegratedOverTheirMaterialAlone) {
  Cage cage = oneTet();
  cage.fineVolumeFraction.assign(kFineTets * kSubTets, 0);
  for (std::size_t k = 0; k < cage.fineVolumeFraction.size(); ++k) {
    if (k % 3 == 0) cage.fineVolumeFraction[k] = static_cast<std::uint8_t>(k % 256);
  }
  cage.volumeFraction.assign(kSubTets, 0.0);
  for (std::size_t k = 0; k < cage.fineVolumeFraction.size(); ++k) {
    cage.volumeFraction[k / kFineTets] += cage.fineVolumeFraction[k] / (255.0 * kFineTets);
  }
  cage.stiffnessFactor = {1.0, 2.0, 0.5, 1.0, 0.25, 1.5, 3.0, 1.0};
  // A thousandth of the full tet is added to it.
  double ghost = 0.0;
  for (const double factor : cage.stiffnessFactor) ghost += 1e-3 * factor / kSubTets;
  const RestQuadraticTet rest = restOf(cage);
  for (const auto& f : quadratics()) {
    const auto factor = [&](std::size_t cell) {
      return cage.stiffnessFactor[cell / kFineTets] * cage.fineVolumeFraction[cell] / 255.0 + ghost;
    };
    EXPECT_NEAR(byPoints(rest, f), byCells(cage, factor, f), 1e-14);
  }
}

TEST(RestQuadraticTets, HaveOneFactorPerTetWhereOneIsGiven) {
  Cage cage = oneTet();
  cage.volumeFraction.assign(kSubTets, 0.5);
  cage.fineVolumeFraction.assign(kFineTets * kSubTets, 128);
  std::vector<double> scale;
  for (std::size_t t = 0; t < kSubTets; ++t) scale.push_back(0.5 + static_cast<double>(t));
  const RestQuadraticTet rest = restOf(cage, scale);
  for (const auto& f : quadratics()) {
    EXPECT_NEAR(byPoints(rest, f),
                byCells(
                    cage, [&](std::size_t cell) { return scale[cell / kFineTets]; }, f),
                1e-13);
  }
}

TEST(RestQuadraticTets, WithoutMaterialKeepATraceOfThemselves) {
  Cage cage = oneTet();
  cage.fineVolumeFraction.assign(kFineTets * kSubTets, 0);
  cage.volumeFraction.assign(kSubTets, 0.0);
  const RestQuadraticTet rest = restOf(cage), full = restOf(oneTet());
  EXPECT_NEAR(rest.volume, 1e-3 * full.volume, 1e-15);
  for (std::size_t k = 0; k < rest.points.size(); ++k) EXPECT_NEAR(rest.points[k], full.points[k], 1e-12);
}

}  // namespace
}  // namespace tetskin::elastic_detail
