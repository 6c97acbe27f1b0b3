// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/matrix/rigid_motions.h>
#include <tetskin/elastic/src/modes/two_level_solver.h>

#include <functional>
#include <optional>

namespace tetskin::elastic_detail {

/// The eigenvalue problem of a body's vibrations. Vectors are displacements times the square roots of their nodes'
/// masses: this makes the mass matrix the identity, and leaves only the stiffness.
class VibrationProblem {
 public:
  /// tets    of one component, rest space. Not kept
  /// masses  by node
  /// free    by node: true if it is not pinned
  VibrationProblem(const TetMesh& tets, BlockRows stiffness, const std::vector<double>& masses,
                   const std::vector<char>& free);
  VibrationProblem(const VibrationProblem&) = delete;

  bool ok() const { return solver_.ok(); }
  Eigen::Index size() const { return inverseRoots_.size(); }
  /// The number of displacements that may be nonzero.
  Eigen::Index freedoms() const { return freedoms_; }
  double largestFrequency() const { return solver_.largestFrequency(); }

  Fields times(const Fields& vectors) const;
  /// An approximate inverse of `times`.
  Fields precondition(const Fields& vectors) const;
  /// The number of rigid motions: 6 for a free body, otherwise 0.
  Eigen::Index rigidCount() const { return rigid_ ? rigid_->count() : 0; }
  void removeRigid(Fields& vectors) const {
    if (rigid_) vectors = possible(vectors);
  }
  /// Vectors without rigid motions, and 0 at pinned nodes.
  Fields possible(const Fields& vectors) const;
  Fields displacements(const Fields& vectors) const { return inverseRoots_.asDiagonal() * vectors; }

 private:
  BlockRows stiffness_;
  TwoLevelSolver solver_;
  Eigen::VectorXd roots_, inverseRoots_;  ///< square roots of the masses, and their inverses; 0 at pinned nodes
  Eigen::Index freedoms_ = 0;
  std::optional<RigidMotions> rigid_;  ///< for a free body only
};

struct Vibrations {
  Eigen::VectorXd eigenvalues;  ///< count, ascending
  Fields vectors;               ///< 3 nodes x count, orthonormal, see VibrationProblem
  int iterations = 0;
  bool converged = false;
};

/// The `count` smallest eigenvalues, without those of rigid motions.
/// count     at most the number of freedoms, minus 6 if nothing is pinned
/// progress  called with the fraction done; may be empty
Vibrations softestVibrations(const VibrationProblem& problem, int count, const std::function<void(double)>& progress);

}  // namespace tetskin::elastic_detail
