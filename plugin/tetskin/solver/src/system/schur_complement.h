// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the matrix of a system's reduced unknowns, sparse by the groups of unknowns that rows
// couple, ordered once per step and factored once per pass.
#pragma once

#include <tetskin/core/src/base/arithmetic/small_matrix.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

namespace tetskin::bullet_detail {

/// Solves (M + K) x = b for groups of unknowns: those of a rigid body, or of a component. With M^-1 = F F^T for rigid
/// bodies, which may be singular since axes may be locked, and F = 1 for the others, whose mass K contains:
///   x = F (E + F^T K F)^-1 F^T b,    E = 1 for rigid bodies, 0 for the others
/// The matrix in the middle is symmetric and positive, so that Cholesky's method factors it.
///
/// This work is based on:
///   Patrick Amestoy, Timothy Davis, Iain Duff, "An Approximate Minimum Degree Ordering Algorithm", SIAM Journal on
///   Matrix Analysis and Applications 17(4), 1996, doi 10.1137/S0895479894278952 (the ordering, by Eigen)
class SchurComplement {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  using Block = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;

  /// Adds the unknowns of a rigid body; returns the index of the first of them.
  /// inverseMass  M^-1, positive or singular
  Eigen::Index addRigid(const Matrix& inverseMass);
  /// Adds unknowns whose mass is in K; returns the index of the first of them.
  Eigen::Index add(Eigen::Index size);
  /// Reserves blocks of K; the groups are named by their first unknowns.
  void couple(Eigen::Index a, Eigen::Index b);
  /// Finds the order of elimination. Call it when all groups have been added and coupled.
  void order();

  /// K = 0
  void setZero();
  /// The block of K with the rows of one group, and the columns of the same or an earlier one. There is none for the
  /// opposite, as K is symmetric.
  Block block(Eigen::Index row, Eigen::Index column);
  /// Adds to a block of six rows and columns.
  void add(Eigen::Index row, Eigen::Index column, const Small6x6& more);
  /// Adds sign a^T h b to a block.
  void addProduct(Eigen::Index row, Eigen::Index column, double sign, const Eigen::Matrix<double, 3, Eigen::Dynamic>& a,
                  const Small3x3& h, const Eigen::Matrix<double, 3, Eigen::Dynamic>& b);
  /// Replaces K by its factors.
  /// Cost  O(n) where groups are coupled like the links of chains or trees, O(n^3) where all are coupled with all
  void factor();
  Vector solve(Vector right) const;
  /// M^-1 times the unknowns of the rigid bodies; those of others are left as they are.
  Vector timesInverseMass(Vector unknowns) const;
  Eigen::Index size() const { return size_; }

 private:
  struct Group {
    Eigen::Index first = 0, size = 0;
    Matrix inverseMass, root;        ///< M^-1 and F; empty: 1
    std::vector<std::size_t> rows;   ///< this group, and later ones that are coupled with it
    std::vector<Eigen::Index> tops;  ///< of those blocks: by number of the row within the column
    Eigen::Index height = 0;         ///< of its columns
    Eigen::Index firstValue = 0;     ///< of its first column

    bool isRigid() const { return root.size() > 0; }
  };
  /// What `transform` multiplies with.
  enum class Factor { Root, TransposedRoot };
  void transform(Factor factor, Vector& unknowns) const;
  Group& groupAt(Eigen::Index first);

  Eigen::Index size_ = 0;
  std::vector<Group> groups_;
  std::vector<std::size_t> groupOf_;    ///< by unknown
  Eigen::SparseMatrix<double> matrix_;  ///< its lower triangle, and the whole of the blocks on the diagonal
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::LDLT<Matrix> pivoted_;
  bool isPositive_ = true;  ///< `factor_` is in use; otherwise, because of rounding, `pivoted_`
};

}  // namespace tetskin::bullet_detail
