// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/lists.h>
#include <tetskin/elastic/src/matrix/linear_elasticity.h>

#include <Eigen/SparseCore>
#include <vector>

namespace tetskin::elastic_detail {

/// The stiffness matrix of a cage at rest as rows of 3x3 blocks, which maps displacements to forces: 3N x 3N,
/// symmetric, positive except for rigid motions.
class BlockRows {
 public:
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

  /// cage   valid, rest space, no tet flat; its quadratic tets are used as such. Not kept
  /// scale  by tet: stiffness factor relative to a Young's modulus of 1; empty: the cage's, over its material
  /// Cost   O(T log T) for T tets
  BlockRows(const Cage& cage, double poissonRatio, const std::vector<double>& scale);

  /// product  of the same size, overwritten
  void multiply(const Fields& fields, Fields& product) const;
  Eigen::VectorXd diagonal() const;
  const Block& diagonalBlock(std::size_t node) const;
  /// By node: the node itself and the nodes with which it shares a linear or quadratic tet, ascending.
  const Lists<>& neighbours() const { return columns_; }
  /// The whole matrix, both triangles.
  Eigen::SparseMatrix<double, Eigen::RowMajor> sparse() const;

 private:
  std::size_t indexOf(int row, int column) const;
  template <class Nodes, class Matrix>
  void add(const Nodes& nodes, const Matrix& stiffness);
  Block& block(int row, int column) { return blocks_[indexOf(row, column)]; }
  template <int kColumns>
  void multiplyColumns(Eigen::Index first, const Fields& fields, Fields& product) const;

  Lists<> columns_;  ///< by node, ascending
  std::vector<Block> blocks_;
};

}  // namespace tetskin::elastic_detail
