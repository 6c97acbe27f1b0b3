// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the matrix of a system's reduced unknowns, factored once per pass.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace tetskin::bullet_detail {

/// Solves (M + K) x = b for the reduced unknowns, of which the rigid bodies' come first. With M^-1 = F F^T for these,
/// which may be singular since axes may be locked, and F = 1 for the others, the mass of which K contains:
///   x = F (E + F^T K F)^-1 F^T b,    E = 1 for rigid bodies, 0 for the others
/// The matrix in the middle is symmetric and positive, so that Cholesky's method factors it.
class SchurComplement {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// inverseMass  M^-1 of the rigid bodies, positive or singular; may be empty
  void setInverseMass(const Matrix& inverseMass);
  /// stiffness  K, of all unknowns, symmetric
  /// Cost       O(n^3)
  void factor(Matrix stiffness);
  /// Cost  O(n^2)
  Vector solve(Vector right) const;
  Eigen::Index size() const { return matrix_.rows(); }

 private:
  Matrix root_;    ///< F of the rigid bodies
  Matrix matrix_;  ///< as `factor` has found it
  Eigen::LLT<Matrix> factor_;
  Eigen::LDLT<Matrix> pivoted_;
  bool isPositive_ = true;  ///< `factor_` is in use; otherwise, because of rounding, `pivoted_`
};

}  // namespace tetskin::bullet_detail
