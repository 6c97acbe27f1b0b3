// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/tet_mesh.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace tetskin::elastic_detail {

/// Several displacements, loads or accelerations at once: 3 nodeCount x count. A matrix is then read once for all of
/// them, which is what a product takes its time for.
using Fields = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A stiffness matrix as rows of 3x3 blocks, for products alone.
class BlockRows {
 public:
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

  /// scale  by tet: times the stiffness of a Young's modulus of 1
  BlockRows(const TetMesh& mesh, double poissonRatio, const std::vector<double>& scale);

  /// product  of the same size, overwritten
  void multiply(const Fields& fields, Fields& product) const;
  Eigen::VectorXd diagonal() const;
  const Block& diagonalBlock(std::size_t node) const;
  /// By node: itself and those that it shares a tet with, ascending.
  const Lists<>& neighbours() const { return columns_; }
  Eigen::SparseMatrix<double, Eigen::RowMajor> sparse() const;

 private:
  std::size_t indexOf(int row, int column) const;
  Block& block(int row, int column) { return blocks_[indexOf(row, column)]; }
  template <int kColumns>
  void multiplyColumns(Eigen::Index first, const Fields& fields, Fields& product) const;

  Lists<> columns_;  ///< by node, ascending
  std::vector<Block> blocks_;
};

}  // namespace tetskin::elastic_detail
