// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/elastic/src/tets/rest_quadratic_tets.h>

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// Share of the whole tet that is added to its material. Without it, a tet with material in only one corner would move
/// freely; a tenth makes the bodies that the surface cuts a third too stiff; this much has no visible effect.
constexpr double kGhost = 1e-3;

/// Sums over a material: its volume, and the integrals of x and x x^T.
struct Moments {
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add(const TetCorners& p, double factor) {
    const double part = factor * std::abs(signedVolume(p));
    const Eigen::Vector3d centroid = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    volume += part;
    first += part * centroid;
    second += part * centroid * centroid.transpose();
    for (const Eigen::Vector3d& corner : p) {
      second += part / 20.0 * (corner - centroid) * (corner - centroid).transpose();
    }
  }
};

/// The corners in the coordinates of a map.
TetCorners mapped(TetCorners corners, const BarycentricMap& map) {
  for (Eigen::Vector3d& p : corners) p = map(p).tail<3>();
  return corners;
}

/// The material of one of the eight tets, in the quadratic one's weights.
/// corners  rest space, which determines how a tet is cut into cells
/// fine     kFineTets volume fractions in 255ths, or null: full
void addMaterial(const TetCorners& corners, const BarycentricMap& map, double factor, const std::uint8_t* fine,
                 Moments& moments) {
  if (!fine) return moments.add(mapped(corners, map), factor);
  for (const TetCorners& piece : refinedTet(corners)) {
    for (const TetCorners& cell : refinedTet(piece)) moments.add(mapped(cell, map), factor * *fine++ / 255.0);
  }
}

/// Four points of equal weight with these moments: the centroid plus twice the columns of the root of the covariance of
/// all four weights. That root is symmetric, so that no corner is preferred, and the order of a tet's nodes does not
/// matter.
std::array<double, 3 * kQuadraticPoints> pointsWith(const Moments& moments) {
  // Weights relative to the centroid sum to 0; a regular tet with these corners gives them three coordinates.
  Eigen::Matrix<double, 4, 3> regular;
  regular << 0.5, 0.5, 0.5, 0.5, -0.5, -0.5, -0.5, 0.5, -0.5, -0.5, -0.5, 0.5;
  const Eigen::Matrix3d fromLast = (regular.bottomRows<3>().rowwise() - regular.row(0)).transpose();
  const Eigen::Vector3d centroid = moments.first / moments.volume;
  const Eigen::Matrix3d covariance = moments.second / moments.volume - centroid * centroid.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(fromLast * covariance * fromLast.transpose());
  const Eigen::Matrix<double, 4, 4> columns = regular * axes.operatorSqrt() * regular.transpose();
  std::array<double, 3 * kQuadraticPoints> points{};
  for (std::size_t q = 0; q < kQuadraticPoints; ++q) {
    Eigen::Map<Eigen::Vector3d> point(&points[3 * q]);
    point = centroid + 2.0 * columns.col(static_cast<Eigen::Index>(q)).tail<3>();
    assert(point.allFinite());
  }
  return points;
}

}  // namespace

std::vector<RestQuadraticTet> restQuadraticTets(const Cage& cage, const std::vector<QuadraticTet>& tets,
                                                const std::vector<double>& stiffnessScale) {
  assert(stiffnessScale.empty() || stiffnessScale.size() == cage.mesh.tetCount());
  const bool given = !stiffnessScale.empty();
  const std::vector<double> factors = given ? stiffnessScale : cage.materialStiffness();
  // Weights 1 to 3 are coordinates, in which the tet has this volume.
  constexpr double kUnitVolume = 1.0 / 6.0;
  const TetCorners unit = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                           Eigen::Vector3d::UnitZ()};
  std::vector<RestQuadraticTet> rest;
  for (const QuadraticTet& tet : tets) {
    RestQuadraticTet& made = rest.emplace_back();
    made.nodes = tet.nodes;
    made.cageTets = tet.tets;
    const TetCorners corners = cornersOf(cage.mesh, {tet.nodes[0], tet.nodes[1], tet.nodes[2], tet.nodes[3]});
    const BarycentricMap map(corners);
    const std::array<Eigen::Vector3d, 4> gradients = map.gradients();
    for (std::size_t k = 0; k < 9; ++k) made.gradients[k] = gradients[1 + k / 3][static_cast<Eigen::Index>(k % 3)];
    Moments moments;
    double ghost = 0.0;
    for (const int t : tet.tets) {
      double factor = factors.empty() ? 1.0 : factors[t];
      ghost += kGhost * factor / static_cast<double>(kSubTets);
      const bool fine = !given && !cage.fineVolumeFraction.empty();
      if (!given && !fine && !cage.volumeFraction.empty()) factor *= cage.volumeFraction[t];
      addMaterial(cornersOf(cage.mesh, cage.mesh.tets[t]), map, factor,
                  fine ? &cage.fineVolumeFraction[kFineTets * static_cast<std::size_t>(t)] : nullptr, moments);
    }
    if (!given && !cage.volumeFraction.empty()) moments.add(unit, ghost);
    made.points = pointsWith(moments);
    made.volume = moments.volume / kUnitVolume * std::abs(signedVolume(corners));
  }
  return rest;
}

}  // namespace tetskin::elastic_detail
