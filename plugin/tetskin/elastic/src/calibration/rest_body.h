// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/matrix/block_rows.h>
#include <tetskin/elastic/src/matrix/rigid_motions.h>

#include <Eigen/SparseCholesky>

namespace tetskin::elastic_detail {

/// The scalar product of each column of a with that of b.
inline Eigen::RowVectorXd products(const Fields& a, const Fields& b) {
  Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(a.cols());
  for (Eigen::Index row = 0; row < a.rows(); ++row) sums += a.row(row).cwiseProduct(b.row(row));
  return sums;
}

/// The linear model of a free body at rest.
struct RestBody {
  /// cage, scale  see BlockRows
  /// nodeMasses   see `lumpedVolumes`
  RestBody(const Cage& cage, double poissonRatio, const std::vector<double>& scale, Eigen::VectorXd nodeMasses);
  RestBody(const RestBody&) = delete;

  Eigen::SparseMatrix<double> stiffness;  ///< lower triangle, as the factorisation reads it
  Eigen::VectorXd masses;
  RigidMotions rigid;
};

/// Computes displacements under loads from a factorisation that is made once: for bodies of up to some tens of
/// thousands of tets.
class DirectSolver {
 public:
  /// body  must outlive this
  explicit DirectSolver(const RestBody& body);
  bool ok() const { return factors_.info() == Eigen::Success; }
  /// loads  balanced, see RigidMotions. The result contains no rigid motion.
  Fields solve(const Fields& loads) const;

 private:
  const RestBody& body_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

/// The `count` softest vibrations of a body, softest first: 3N x count (or fewer, if N is small), of unit generalised
/// mass each, without rigid motions. Subspace iteration; cost: some 10 x count solves.
///
/// `softestVibrations` needs no factorisation, which suits large bodies, but takes three to ten times as long (cages of
/// 3,000 tets), and supports neither several components nor hinges; calibration needs the factorisation anyway.
///
/// This work is based on:
///   Klaus-Jürgen Bathe, "Finite Element Procedures", 2014, section 11.6 (subspace iteration)
Eigen::MatrixXd softestModes(const RestBody& body, const DirectSolver& solver, int count);

}  // namespace tetskin::elastic_detail
