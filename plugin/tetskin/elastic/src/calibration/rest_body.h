// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/matrix/block_rows.h>
#include <tetskin/elastic/src/matrix/rigid_motions.h>

#include <Eigen/SparseCholesky>

namespace tetskin::elastic_detail {

/// A body at rest that nothing holds, as small displacements see it.
struct RestBody {
  /// scale       by tet: times the stiffness of a Young's modulus of 1
  /// nodeMasses  see `lumpedVolumes`
  RestBody(const TetMesh& mesh, double poissonRatio, const std::vector<double>& scale, Eigen::VectorXd nodeMasses);
  RestBody(const RestBody&) = delete;

  Eigen::SparseMatrix<double> stiffness;  ///< lower triangle, which a factorisation takes
  Eigen::VectorXd masses;
  RigidMotions rigid;
};

/// Its displacements under loads, by a factorisation that is made once: for bodies of up to some tens of thousands of
/// tets.
class DirectSolver {
 public:
  /// body  must outlive this
  explicit DirectSolver(const RestBody& body);
  bool ok() const { return factors_.info() == Eigen::Success; }
  /// loads  balanced (see RigidMotions). Without rigid motion.
  Fields solve(const Fields& loads) const;

 private:
  const RestBody& body_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

/// The `count` softest vibrations of a body, softest first: 3N x count (or fewer, if N is small), of unit generalised
/// mass each, without rigid motions. Subspace iteration; cost: some 10 x count solves.
///
/// Not `softestVibrations`, which finds them without factors, as large bodies need, but in three to ten times the time
/// (cages of 3,000 tets), of one part alone, and not where parts are hinged; calibration needs the factors anyway.
///
/// This work is based on:
///   Klaus-Jürgen Bathe, "Finite Element Procedures", 2014, section 11.6 (subspace iteration)
Eigen::MatrixXd softestModes(const RestBody& body, const DirectSolver& solver, int count);

}  // namespace tetskin::elastic_detail
