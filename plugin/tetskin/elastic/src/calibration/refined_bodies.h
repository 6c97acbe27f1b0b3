// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/mesh/uniform_refinement.h>
#include <tetskin/elastic/src/calibration/elastic_modes.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace tetskin::elastic_detail {

/// A body and its uniform refinements: the same shape, with eight times the tets from level to level. Displacements of
/// a level are those of the next as well, once its midpoints are filled in.
class RefinedBodies {
 public:
  /// Check `ok()`.
  RefinedBodies(const TetMesh& coarsest, double poissonRatio, int refinements);

  bool ok() const { return direct_.ok(); }
  std::size_t levelCount() const { return levels_.size(); }
  const ElasticBody& body(std::size_t level) const { return levels_[level]->body; }
  /// Of the coarsest level.
  const DirectSolver& direct() const { return direct_; }

  /// A displacement of `level` in terms of `level + 1`.
  Eigen::VectorXd refined(std::size_t level, const Eigen::VectorXd& displacement) const;
  /// The displacement under a balanced load, starting from a guess: conjugate gradients, preconditioned by all coarser
  /// levels, so that the number of iterations does not grow with the size or slenderness of the body.
  Eigen::VectorXd solve(std::size_t level, const Eigen::VectorXd& load, const Eigen::VectorXd& guess) const;

 private:
  struct Level {
    Level(Refinement refinement, double poissonRatio);
    Refinement refinement;  ///< of the level before; for the first, the mesh without edges
    ElasticBody body;
    Eigen::VectorXd diagonal;  ///< of the stiffness
  };

  /// What the nodes of `level - 1` feel of a load on `level`: the transpose of `refined`.
  Eigen::VectorXd coarsened(std::size_t level, const Eigen::VectorXd& load) const;
  Eigen::VectorXd precondition(std::size_t level, const Eigen::VectorXd& load) const;

  std::vector<std::unique_ptr<Level>> levels_;
  DirectSolver direct_;
};

}  // namespace tetskin::elastic_detail
