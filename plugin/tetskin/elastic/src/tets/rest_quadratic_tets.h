// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The integration points of quadratic tets: four points, with the volume, the centroid and the covariance of the
// material in the tet. This is exact for the products of the linear strains of such a tet with any filling; in a full
// tet it is the usual four-point rule. No point has a negative weight, and with four points every deformation causes a
// force.
#pragma once

#include <tetskin/core/cage.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin::elastic_detail {

/// Number of integration points of a quadratic tet.
constexpr std::size_t kQuadraticPoints = 4;

/// A quadratic tet at rest. Its strain is given by its four barycentric weights L; see `QuadraticTet` for its nodes.
struct RestQuadraticTet {
  std::array<int, kQuadraticNodes> nodes{};
  std::array<double, 9> gradients{};  ///< by rows: of the weights of corners 1, 2 and 3, rest space
  /// Barycentric weights of corners 1, 2 and 3 at each point.
  std::array<double, 3 * kQuadraticPoints> points{};
  /// Integral of the stiffness factor over the material, a quarter for each point; above 0. For a full tet with the
  /// factor 1, its volume.
  double volume = 0.0;
  std::array<int, kSubTets> cageTets{};  ///< the tets of the cage that it is
};

/// The slopes of the four barycentric weights along a vector.
/// gradients  by rows: of the weights of corners 1, 2 and 3
inline std::array<double, 4> weightSlopes(const std::array<double, 9>& gradients, const Eigen::Vector3d& along) {
  std::array<double, 4> slopes{};
  for (std::size_t k = 0; k < 3; ++k) {
    slopes[k + 1] = Eigen::Vector3d::Map(&gradients[3 * k]).dot(along);
    slopes[0] -= slopes[k + 1];
  }
  return slopes;
}

/// The slopes of the ten shape functions of a quadratic tet along a vector, at a point; see `QuadraticTet` for its
/// nodes.
/// slopes  see `weightSlopes`
/// point   its weights of corners 1, 2 and 3
inline std::array<double, kQuadraticNodes> quadraticSlopes(const std::array<double, 4>& slopes,
                                                           const Eigen::Vector3d& point) {
  const std::array<double, 4> weights = {1.0 - point[0] - point[1] - point[2], point[0], point[1], point[2]};
  std::array<double, kQuadraticNodes> all{};
  std::size_t edge = 4;
  for (std::size_t a = 0; a < 4; ++a) {
    all[a] = (4.0 * weights[a] - 1.0) * slopes[a];
    for (std::size_t b = a + 1; b < 4; ++b) all[edge++] = 4.0 * (weights[a] * slopes[b] + weights[b] * slopes[a]);
  }
  return all;
}

/// The quadratic tets of a cage, none of them flat.
/// cage            if it stores volume fractions, and no stiffnessScale is given, these determine where the material is
/// tets            see `quadraticTets`
/// stiffnessScale  by tet of the cage, above 0; empty: the cage's stiffness factors, over its material
/// Cost            O(64 T) for T tets
TETSKIN_ELASTIC_API std::vector<RestQuadraticTet> restQuadraticTets(const Cage& cage,
                                                                    const std::vector<QuadraticTet>& tets,
                                                                    const std::vector<double>& stiffnessScale);

}  // namespace tetskin::elastic_detail
