// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/elastic/src/matrix/block_rows.h>

#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using elastic_detail::BlockRows;
using elastic_detail::Fields;

constexpr double kPoissonOfRows = 0.3;

TetMesh jitteredBox() {
  return jittered(latticeCage(3, 2, 2), 0.2, 3);
}

std::vector<double> variedScale(const TetMesh& mesh) {
  std::vector<double> scale;
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) scale.push_back(0.1 + static_cast<double>(t % 7));
  return scale;
}

/// The stiffness matrix, summed tet by tet.
MatrixXd denseStiffness(const TetMesh& mesh, const std::vector<double>& scale) {
  const auto size = static_cast<Eigen::Index>(3 * mesh.nodeCount());
  MatrixXd matrix = MatrixXd::Zero(size, size);
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const Tet& tet = mesh.tets[t];
    const MatrixXd stiffness = scale[t] * elastic_detail::tetStiffness(cornersOf(mesh, tet), kPoissonOfRows);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) matrix.block<3, 3>(3 * tet[a], 3 * tet[b]) += stiffness.block<3, 3>(3 * a, 3 * b);
    }
  }
  return matrix;
}

TEST(BlockRows, EnergyOfAnEvenStrainIsExact) {
  const TetMesh mesh = jitteredBox();
  const BlockRows stiffness(mesh, kPoissonOfRows, std::vector<double>(mesh.tetCount(), 1.0));
  Matrix3d gradient;
  gradient << 0.1, 0.3, -0.2, 0.0, -0.4, 0.1, 0.5, 0.2, 0.3;
  const Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double mu = 1.0 / (2.0 * (1.0 + kPoissonOfRows)),
               lambda = kPoissonOfRows / ((1.0 + kPoissonOfRows) * (1.0 - 2.0 * kPoissonOfRows));
  const double density = mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
  VectorXd u(3 * mesh.nodeCount());
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    u.segment<3>(3 * n) = gradient * mesh.nodes[n] + Eigen::Vector3d(1, 2, 3);
  }
  EXPECT_NEAR(0.5 * u.dot(stiffness.sparse() * u), density * totalVolume(mesh), 1e-10);
}

TEST(BlockRows, AreTheSumOfTheTets) {
  const TetMesh mesh = jitteredBox();
  const std::vector<double> scale = variedScale(mesh);
  const BlockRows rows(mesh, kPoissonOfRows, scale);
  const MatrixXd dense = denseStiffness(mesh, scale);
  EXPECT_LT((MatrixXd(rows.sparse()) - dense).norm(), 1e-13 * dense.norm());
  EXPECT_LT((rows.diagonal() - dense.diagonal()).norm(), 1e-13 * dense.norm());
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    const Matrix3d block = dense.block<3, 3>(3 * n, 3 * n);
    EXPECT_LT((rows.diagonalBlock(n) - block).norm(), 1e-13 * block.norm()) << n;
  }
}

TEST(BlockRows, MultiplyAnyNumberOfFields) {
  const TetMesh mesh = jitteredBox();
  const std::vector<double> scale = variedScale(mesh);
  const BlockRows rows(mesh, kPoissonOfRows, scale);
  const MatrixXd dense = denseStiffness(mesh, scale);
  for (const int count : {1, 3, 6, 13}) {  // alone, and together in registers
    const Fields fields = Fields::Random(dense.rows(), count);
    Fields product = fields;
    rows.multiply(fields, product);
    const MatrixXd right = dense * MatrixXd(fields);
    EXPECT_LT((product - right).norm(), 1e-12 * right.norm()) << count;
  }
}

}  // namespace
}  // namespace tetskin::test
