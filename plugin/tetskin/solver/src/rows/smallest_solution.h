// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to joint_impulses.cpp: least squares with few columns, which may depend on each other. By loops, as Eigen's
// decomposition of this kind takes the compiler five seconds; the bits are its.
#pragma once

#include <array>
#include <cstddef>

namespace tetskin::bullet_detail {

/// The smallest x of those for which A x is closest to b.
///
/// This work is based on:
///   Gene Golub, Charles Van Loan, "Matrix Computations", 4th edition, 2013, sections 5.4 and 5.5 (QR by Householder's
///   reflections with pivoting, and the complete orthogonal decomposition)
class SmallestSolution {
 public:
  /// Of A: those of a joint between two rigid bodies, and its degrees of freedom.
  static constexpr std::size_t kRows = 12, kMaxColumns = 6;
  using Columns = std::array<double, kRows * kMaxColumns>;

  /// columns  one after the other: the first `count` of them are A
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

  Columns qr_;  ///< R, below it the reflections; right of the first `rank_` columns those of the rows
  std::size_t count_, rank_ = 0, pivots_ = 0;  ///< pivots_: columns up to one that rounding alone has left
  std::array<double, kMaxColumns> factors_{}, rowFactors_{};  ///< of the reflections
  std::array<double, kMaxColumns> lengths_{}, computed_{};    ///< of what is left of columns; and when last computed
  std::array<std::size_t, kMaxColumns> order_{};              ///< which of A's columns is k-th
};

}  // namespace tetskin::bullet_detail
