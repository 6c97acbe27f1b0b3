// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to elasticity: linear equations of a few unknowns, in plain numbers. The compiler needs a second for each
// size of Eigen's factors, and none for these. They round as Eigen's (PartialPivLU, LDLT) do, without its vectors.
#pragma once

namespace tetskin::elastic_detail {

/// The most unknowns of `solveSmall`.
constexpr int kMostUnknowns = 6;

/// Solves A x = b by factors L U, in each step with the row of the largest pivot. If A is singular, x is not finite.
/// matrix  size x size, by columns; is lost
/// vector  b, which x replaces
void solveSmall(int size, double* matrix, double* vector);

/// The factors L D L^T of a symmetric matrix of 3 x 3, in each step with the row of the largest pivot.
class SymmetricFactors {
 public:
  SymmetricFactors() = default;
  /// matrix  by columns; its lower triangle is read
  explicit SymmetricFactors(const double* matrix);

  /// Replaces b by x such that A x = b. Where A has no inverse, x has no part.
  void solve(double* vector) const;

 private:
  double factors_[9] = {};   ///< by columns: D, and L below it
  int rows_[3] = {0, 1, 2};  ///< by step: the row that was put in its place
};

}  // namespace tetskin::elastic_detail
