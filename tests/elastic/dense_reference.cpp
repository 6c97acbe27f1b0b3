// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "dense_reference.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace tetskin::test::dense {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void solve(const double* a, Index size, const double* b, Index columns, double* x) {
  MatrixXd::Map(x, size, columns) =
      Eigen::PartialPivLU<MatrixXd>(MatrixXd::Map(a, size, size)).solve(MatrixXd::Map(b, size, columns));
}

void eigenvalues(const double* a, const double* masses, Index size, double* values, double* vectors) {
  // With y = sqrt(masses) x, the matrix stays symmetric and the masses become 1.
  const VectorXd scale = VectorXd::Map(masses, size).cwiseSqrt().cwiseInverse();
  const MatrixXd scaled = scale.asDiagonal() * MatrixXd::Map(a, size, size) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled,
                                                       vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  VectorXd::Map(values, size) = solver.eigenvalues();
  if (vectors) MatrixXd::Map(vectors, size, size) = scale.asDiagonal() * solver.eigenvectors();
}

void singularValues(const double* a, double* values, double* rotation) {
  const Eigen::JacobiSVD<Matrix3d> svd(Matrix3d::Map(a), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d::Map(values) = svd.singularValues();
  Matrix3d::Map(rotation) = svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace tetskin::test::dense
