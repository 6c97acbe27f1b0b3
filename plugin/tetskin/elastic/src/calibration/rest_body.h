// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/calibration/block_rows.h>
#include <tetskin/elastic/src/calibration/linear_elasticity.h>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

namespace tetskin::elastic_detail {

/// A body at rest that nothing holds, as small displacements see it.
struct RestBody {
  /// mesh      must outlive this
  /// scale     by tet: times the stiffness of a Young's modulus of 1
  /// ofNodes   see `lumpedVolumes`
  RestBody(const TetMesh& mesh, double poissonRatio, const std::vector<double>& scale, Eigen::VectorXd ofNodes)
      : stiffness(stiffnessMatrix(mesh, poissonRatio, scale)), masses(std::move(ofNodes)), rigid(mesh, masses) {}
  RestBody(const RestBody&) = delete;

  Eigen::SparseMatrix<double> stiffness;
  Eigen::VectorXd masses;
  RigidMotions rigid;
};

/// Its displacements under loads, by a factorisation that is made once: for bodies of up to some tens of thousands of
/// tets.
class DirectSolver {
 public:
  explicit DirectSolver(const RestBody& body);
  bool ok() const { return factors_.info() == Eigen::Success; }
  /// load  balanced (see RigidMotions). Without rigid motion.
  Eigen::VectorXd solve(const Eigen::VectorXd& load) const;
  /// The same of several.
  Fields solve(const Fields& loads) const;

 private:
  const RestBody& body_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

/// The `count` softest vibrations of a body, softest first: 3N x count (or fewer, if N is small), of unit generalised
/// mass each, without rigid motions. Subspace iteration; cost: some 10 x count solves.
///
/// This work is based on:
///   Klaus-Jürgen Bathe, "Finite Element Procedures", 2014, section 11.6 (subspace iteration)
Eigen::MatrixXd softestModes(const RestBody& body, const DirectSolver& solver, int count);

}  // namespace tetskin::elastic_detail
