// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/modes/dense_factors.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cassert>

namespace tetskin::elastic_detail {

Eigenpairs eigenpairsOf(const Eigen::MatrixXd& a) {
  assert(a.rows() == a.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigenpairs eigenpairsOf(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  assert(a.rows() == a.cols() && b.rows() == a.rows() && b.cols() == a.cols());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd orthonormalColumns(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(columns);
  return factors.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

void factorise(const Eigen::MatrixXd& a, DenseCholesky& factors) {
  factors.compute(a);
}

Eigen::MatrixXd solved(const DenseCholesky& factors, const Eigen::MatrixXd& b) {
  return factors.solve(b);
}

}  // namespace tetskin::elastic_detail
