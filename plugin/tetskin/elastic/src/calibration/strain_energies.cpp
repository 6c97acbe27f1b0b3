// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/calibration/strain_energies.h>
#include <tetskin/elastic/src/tets/material.h>

#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// u^T K u for each column of the displacements of these nodes. Sizes are dynamic, because the compiler needs a second
/// for each fixed size of a product.
template <class Stiffness, std::size_t N>
Eigen::RowVectorXd energiesOf(const Stiffness& stiffness, const std::array<int, N>& nodes,
                              const Fields& displacements) {
  static_assert(Stiffness::RowsAtCompileTime == 3 * N);
  Eigen::MatrixXd moved(stiffness.rows(), displacements.cols());
  for (std::size_t k = 0; k < N; ++k) {
    moved.middleRows<3>(static_cast<Eigen::Index>(3 * k)) = displacements.middleRows<3>(3 * nodes[k]);
  }
  const Eigen::MatrixXd forces = Eigen::MatrixXd(stiffness) * moved;
  Eigen::RowVectorXd energies(moved.cols());
  using Column = Eigen::Map<const Eigen::Matrix<double, 3 * N, 1>>;
  for (Eigen::Index k = 0; k < moved.cols(); ++k) energies[k] = Column(&moved(0, k)).dot(Column(&forces(0, k)));
  return energies;
}

}  // namespace

Eigen::MatrixXd strainEnergies(const Cage& cage, double poissonRatio, const std::vector<double>& scale,
                               const Fields& displacements) {
  assert(displacements.rows() == static_cast<Eigen::Index>(3 * cage.mesh.nodeCount()));
  const std::vector<double> factors = scale.empty() ? cage.stiffnessScale() : scale;
  Eigen::MatrixXd energies(static_cast<Eigen::Index>(cage.mesh.tetCount()), displacements.cols());
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (!cage.quadraticTet.empty() && cage.quadraticTet[t] >= 0) continue;
    const Tet& tet = cage.mesh.tets[t];
    energies.row(static_cast<Eigen::Index>(t)) =
        (factors.empty() ? 1.0 : factors[t]) *
        energiesOf(tetStiffness(cornersOf(cage.mesh, tet), poissonRatio), tet, displacements);
  }
  const Result<std::vector<QuadraticTet>> tets = quadraticTets(cage);
  assert(tets.ok());
  const std::vector<RestQuadraticTet> rest = restQuadraticTets(cage, tets.value(), scale);
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const Eigen::RowVectorXd energy = energiesOf(tetStiffness(rest[k], poissonRatio), rest[k].nodes, displacements);
    for (const int t : tets.value()[k].tets) energies.row(t) = energy / static_cast<double>(kSubTets);
  }
  return energies;
}

}  // namespace tetskin::elastic_detail
