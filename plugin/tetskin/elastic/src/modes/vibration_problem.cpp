// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/modes/softest_vibrations.h>

#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {

VibrationProblem::VibrationProblem(const TetMesh& tets, BlockRows stiffness, const std::vector<double>& masses,
                                   const std::vector<char>& free)
    : stiffness_(std::move(stiffness)),
      solver_(stiffness_, tets.nodes, masses, free),
      roots_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * tets.nodeCount()))),
      inverseRoots_(roots_) {
  assert(masses.size() == tets.nodeCount() && free.size() == tets.nodeCount());
  for (std::size_t n = 0; n < tets.nodeCount(); ++n) {
    if (!free[n]) continue;
    roots_.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(std::sqrt(masses[n]));
    inverseRoots_.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(1.0 / std::sqrt(masses[n]));
    freedoms_ += 3;
  }
  if (freedoms_ == size()) rigid_.emplace(tets, roots_.cwiseAbs2());
}

Fields VibrationProblem::times(const Fields& vectors) const {
  assert(vectors.rows() == size());
  const Fields moved = displacements(vectors);
  Fields forces(vectors.rows(), vectors.cols());
  stiffness_.multiply(moved, forces);
  return inverseRoots_.asDiagonal() * forces;
}

Fields VibrationProblem::precondition(const Fields& vectors) const {
  assert(vectors.rows() == size());
  Fields loads = roots_.asDiagonal() * vectors;
  if (rigid_) rigid_->balance(loads);
  Fields moved = solver_.solve(loads);
  if (rigid_) rigid_->removeFrom(moved);
  return roots_.asDiagonal() * moved;
}

Fields VibrationProblem::possible(const Fields& vectors) const {
  Fields moved = displacements(vectors);
  if (rigid_) rigid_->removeFrom(moved);
  return roots_.asDiagonal() * moved;
}

}  // namespace tetskin::elastic_detail
