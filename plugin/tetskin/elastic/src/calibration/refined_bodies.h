// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/elastic/src/calibration/rest_body.h>

#include <array>
#include <cassert>
#include <cstddef>
#include <memory>
#include <vector>

namespace tetskin::elastic_detail {

/// A cage and its uniform refinements: the same shape, with eight times the tets from level to level. Displacements of
/// a level become displacements of the next one by interpolating its midpoints. Two refinements are linear:
/// extrapolated with order two, they are within a per cent of quadratic tets on the second one, in half the time. A
/// single refinement consists of quadratic tets, because linear ones alone would be too far from the limit.
class RefinedBodies {
 public:
  /// The coarsest level has the stiffness and mass of the body; finer levels have the volume fractions at their own
  /// resolution, from `Cage::fineVolumeFraction`. Check `ok()`.
  ///
  /// cage         every node is used by a tet; some tets may be quadratic
  /// refinements  at most two
  RefinedBodies(Cage cage, double poissonRatio, int refinements);

  bool ok() const { return direct_.ok(); }
  std::size_t levelCount() const { return levels_.size() + 1; }
  const Cage& cage() const { return cage_; }
  double poissonRatio() const { return poissonRatio_; }
  const RestBody& coarsest() const { return coarsest_; }
  const DirectSolver& direct() const { return direct_; }
  const Eigen::VectorXd& masses(std::size_t level) const { return level == 0 ? coarsest_.masses : at(level).masses; }
  /// See RigidMotions::balance.
  void balance(std::size_t level, Fields& loads) const {
    (level == 0 ? coarsest_.rigid : at(level).rigid).balance(loads);
  }

  /// Interpolates displacements of `level` to `level + 1`.
  Fields refined(std::size_t level, const Fields& displacements) const;
  /// Restricts loads on `level` to the nodes of `level - 1`: the transpose of `refined`.
  Fields coarsened(std::size_t level, const Fields& loads) const;
  /// The displacements under balanced loads, starting from a guess: conjugate gradients, preconditioned by all coarser
  /// levels, so that the number of iterations does not grow with the size or slenderness of the body.
  Fields solve(std::size_t level, const Fields& loads, const Fields& guess) const;
  /// Twice the strain energies, by tet of the cage and displacement. The level must have linear tets.
  Eigen::MatrixXd energies(std::size_t level, const Fields& displacements) const;

 private:
  struct Level {
    /// cage       the coarsest one, for its painted maps
    /// quadratic  empty: linear tets; otherwise the cage of quadratic ones
    Level(Refinement refinement, double poissonRatio, const std::vector<double>& fill, const Cage& cage,
          const Cage& quadratic);
    Refinement refinement;      ///< of the coarser level
    std::vector<double> scale;  ///< by tet
    BlockRows stiffness;
    Eigen::VectorXd masses, diagonal;
    RigidMotions rigid;
  };

  const Level& at(std::size_t level) const {
    assert(level > 0 && level <= levels_.size());
    return *levels_[level - 1];
  }
  Fields precondition(std::size_t level, const Fields& loads) const;

  Cage cage_;
  double poissonRatio_;
  RestBody coarsest_;
  DirectSolver direct_;
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace tetskin::elastic_detail
