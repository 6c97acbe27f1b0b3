// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/matrix/rigid_motions.h>
#include <tetskin/elastic/src/modes/two_level_solver.h>

#include <functional>
#include <optional>

namespace tetskin::elastic_detail {

/// A body as its vibrations see it. Vectors are displacements times the root of their nodes' masses: then mass is 1,
/// and stiffness alone is left.
class VibrationProblem {
 public:
  /// tets    of one part, rest space. Not referred to later
  /// masses  by node
  /// free    by node: not pinned
  VibrationProblem(const TetMesh& tets, BlockRows stiffness, const std::vector<double>& masses,
                   const std::vector<char>& free);
  VibrationProblem(const VibrationProblem&) = delete;

  bool ok() const { return solver_.ok(); }
  Eigen::Index size() const { return inverseRoots_.size(); }
  /// Of displacements that may be other than 0.
  Eigen::Index freedoms() const { return freedoms_; }
  double largestFrequency() const { return solver_.largestFrequency(); }

  Fields times(const Fields& vectors) const;
  /// Roughly the inverse of `times`.
  Fields precondition(const Fields& vectors) const;
  /// Of rigid motions: 6 of a body that nothing holds; otherwise none.
  Eigen::Index rigidCount() const { return rigid_ ? rigid_->count() : 0; }
  void removeRigid(Fields& vectors) const;
  /// Ascending, as many as freedoms.
  std::vector<Eigen::Index> freeRows() const;
  /// Of the free rows, for bodies of which few are.
  Eigen::MatrixXd dense() const;
  Fields displacements(const Fields& vectors) const { return inverseRoots_.asDiagonal() * vectors; }

 private:
  BlockRows stiffness_;
  TwoLevelSolver solver_;
  Eigen::VectorXd roots_, inverseRoots_;  ///< of the masses; 0 where a node is pinned
  Eigen::Index freedoms_ = 0;
  std::optional<RigidMotions> rigid_;  ///< of a body that nothing holds
};

struct Vibrations {
  Eigen::VectorXd eigenvalues;  ///< count, ascending
  Fields vectors;               ///< 3 nodes x count, orthonormal, see VibrationProblem
  int iterations = 0;
  bool converged = false;
};

/// The `count` smallest eigenvalues but those of rigid motions.
/// count     at most freedoms, less 6 if nothing is pinned
/// progress  told the share that is done; may be empty
Vibrations softestVibrations(const VibrationProblem& problem, int count, const std::function<void(double)>& progress);

}  // namespace tetskin::elastic_detail
