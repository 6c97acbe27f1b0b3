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

void VibrationProblem::removeRigid(Fields& vectors) const {
  if (!rigid_) return;
  Fields moved = displacements(vectors);
  rigid_->removeFrom(moved);
  vectors = roots_.asDiagonal() * moved;
}

std::vector<Eigen::Index> VibrationProblem::freeRows() const {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < size(); ++k) {
    if (roots_[k] > 0.0) rows.push_back(k);
  }
  return rows;
}

Eigen::MatrixXd VibrationProblem::dense() const {
  std::vector<Eigen::Index> indexOf(static_cast<std::size_t>(size()), -1);
  Eigen::Index count = 0;
  for (const Eigen::Index row : freeRows()) indexOf[static_cast<std::size_t>(row)] = count++;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  const auto sparse = stiffness_.sparse();
  using Sparse = std::remove_const_t<decltype(sparse)>;
  for (Eigen::Index outer = 0; outer < sparse.outerSize(); ++outer) {
    for (typename Sparse::InnerIterator entry(sparse, outer); entry; ++entry) {
      const Eigen::Index i = indexOf[static_cast<std::size_t>(entry.row())];
      const Eigen::Index j = indexOf[static_cast<std::size_t>(entry.col())];
      if (i < 0 || j < 0) continue;
      matrix(i, j) = inverseRoots_[entry.row()] * entry.value() * inverseRoots_[entry.col()];
    }
  }
  return matrix;
}

}  // namespace tetskin::elastic_detail
