// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Approximate displacements under loads: smoothing on the nodes, plus an exact solve for the rigid motions of groups of
// nodes.
#pragma once

#include <tetskin/elastic/src/matrix/block_rows.h>
#include <tetskin/elastic/src/modes/dense_factors.h>

#include <Eigen/SparseCore>
#include <vector>

namespace tetskin::elastic_detail {

/// An approximate inverse of a stiffness matrix: linear, symmetric and positive, as preconditioners must be.
class TwoLevelSolver {
 public:
  /// stiffness  must outlive this
  /// nodes      rest positions of all nodes
  /// masses     by node
  /// free       by node: true if it is not pinned
  TwoLevelSolver(const BlockRows& stiffness, const std::vector<Eigen::Vector3d>& nodes,
                 const std::vector<double>& masses, const std::vector<char>& free);

  /// False if the matrix of the groups' motions is not positive.
  bool ok() const { return coarse_.info() == Eigen::Success; }
  /// Solves for each load; 0 at pinned nodes.
  Fields solve(const Fields& loads) const;
  /// An upper bound of stiffness over mass, which is a squared frequency: a shift must be small compared with it.
  double largestFrequency() const { return largestFrequency_; }

 private:
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

  Fields timesInverseDiagonal(const Fields& loads) const;
  void smooth(const Fields& loads, Fields& displacements, bool fromZero) const;
  void estimateLargest(const std::vector<double>& masses);

  const BlockRows& stiffness_;
  std::vector<Block> inverseDiagonal_;  ///< by node; 0 if it is pinned
  double largest_ = 0.0;                ///< largest eigenvalue of the inverse diagonal times the stiffness
  double largestFrequency_ = 0.0;
  Eigen::SparseMatrix<double, Eigen::RowMajor> interpolation_;  ///< 3 nodes x motions of groups
  DenseCholesky coarse_;
};

}  // namespace tetskin::elastic_detail
