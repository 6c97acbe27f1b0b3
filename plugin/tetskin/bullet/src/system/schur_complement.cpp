// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/system/schur_complement.h>

#include <cassert>

namespace tetskin::bullet_detail {

void SchurComplement::setInverseMass(const Matrix& inverseMass) {
  assert(inverseMass.rows() == inverseMass.cols());
  root_.resize(inverseMass.rows(), inverseMass.cols());
  if (inverseMass.rows() == 0) return;
  const Eigen::LDLT<Matrix> factors(inverseMass);
  root_ = factors.matrixL();
  root_ *= factors.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  root_ = (factors.transpositionsP().transpose() * root_).eval();
}

void SchurComplement::factor(Matrix stiffness) {
  const Eigen::Index rigid = root_.rows();
  assert(stiffness.rows() == stiffness.cols() && stiffness.rows() >= rigid);
  matrix_ = std::move(stiffness);
  if (rigid > 0) {
    matrix_.topRows(rigid) = (root_.transpose() * matrix_.topRows(rigid)).eval();
    matrix_.leftCols(rigid) = (matrix_.leftCols(rigid) * root_).eval();
    matrix_.topLeftCorner(rigid, rigid).diagonal().array() += 1.0;
  }
  factor_.compute(matrix_);
  isPositive_ = factor_.info() == Eigen::Success;
  if (!isPositive_) pivoted_.compute(matrix_);
}

SchurComplement::Vector SchurComplement::solve(Vector right) const {
  const Eigen::Index rigid = root_.rows();
  assert(right.size() == matrix_.rows());
  if (rigid > 0) right.head(rigid) = (root_.transpose() * right.head(rigid)).eval();
  if (isPositive_) {
    factor_.solveInPlace(right);
  } else {
    right = pivoted_.solve(right).eval();
  }
  if (rigid > 0) right.head(rigid) = (root_ * right.head(rigid)).eval();
  return right;
}

}  // namespace tetskin::bullet_detail
