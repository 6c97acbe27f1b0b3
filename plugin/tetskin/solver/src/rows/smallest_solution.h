// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to joint_impulses.cpp: least squares with few columns, which may be linearly dependent. Written as loops
// because Eigen's decomposition of this kind takes the compiler five seconds; the results have the same bits.
#pragma once

#include <array>
#include <cstddef>

namespace tetskin::bullet_detail {

/// The smallest of all x for which A x is closest to b.
///
/// This work is based on:
///   Gene Golub, Charles Van Loan, "Matrix Computations", 4th edition, 2013, sections 5.4 and 5.5 (QR by Householder's
///   reflections with pivoting, and the complete orthogonal decomposition)
class SmallestSolution {
 public:
  /// Sizes of A: a joint's force and torque on two rigid bodies, and its degrees of freedom.
  static constexpr std::size_t kRows = 12, kMaxColumns = 6;
  using Columns = std::array<double, kRows * kMaxColumns>;

  /// columns  A's columns are the first `count`
  SmallestSolution(const Columns& columns, std::size_t count);
  /// The first `count` numbers are the solution; the others are 0.
  std::array<double, kMaxColumns> solve(std::array<double, kRows> b) const;

 private:
  double& at(std::size_t row, std::size_t column) { return qr_[kRows * column + row]; }
  const double* from(std::size_t row, std::size_t column) const { return &qr_[kRows * column + row]; }
  void exchangeWithLongest(std::size_t k);
  void shortenLengths(std::size_t k);
  void findRank();
  void reduceRows();

  Columns qr_;  ///< R, with the reflections of columns below it, and those of rows right of the first `rank_` columns
  std::size_t count_, rank_ = 0, pivots_ = 0;  ///< pivots_: columns before the first one that is only rounding
  std::array<double, kMaxColumns> factors_{}, rowFactors_{};  ///< of the reflections
  std::array<double, kMaxColumns> lengths_{}, computed_{};  ///< of the columns' remaining parts; and when last computed
  std::array<std::size_t, kMaxColumns> order_{};            ///< which of A's columns is k-th
};

}  // namespace tetskin::bullet_detail
