// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/modes/softest_vibrations.h>

#include <Eigen/QR>
#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {

VibrationProblem::VibrationProblem(BlockRows stiffness, const std::vector<Eigen::Vector3d>& nodes,
                                   const std::vector<double>& masses, const std::vector<char>& free)
    : stiffness_(std::move(stiffness)),
      solver_(stiffness_, nodes, masses, free),
      roots_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * nodes.size()))),
      inverseRoots_(roots_) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!free[n]) continue;
    roots_.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(std::sqrt(masses[n]));
    inverseRoots_.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(1.0 / std::sqrt(masses[n]));
    freedoms_ += 3;
  }
  rigid_.resize(size(), freedoms_ == size() ? 6 : 0);
  if (rigid_.cols() == 0) return;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& node : nodes) centre += node / static_cast<double>(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Eigen::Vector3d arm = nodes[n] - centre;
    const auto at = static_cast<Eigen::Index>(3 * n);
    rigid_.block<3, 3>(at, 0).setIdentity();
    rigid_.block<3, 3>(at, 3) << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  }
  rigid_ = roots_.asDiagonal() * rigid_;
  rigid_.colwise().normalize();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rigid_);
  rigid_ = qr.householderQ() * Eigen::MatrixXd::Identity(size(), 6);
}

Fields VibrationProblem::times(const Fields& vectors) const {
  const Fields moved = displacements(vectors);
  Fields forces(vectors.rows(), vectors.cols());
  stiffness_.multiply(moved, forces);
  return inverseRoots_.asDiagonal() * forces;
}

Fields VibrationProblem::precondition(const Fields& vectors) const {
  Fields balanced = vectors;
  removeRigid(balanced);
  Fields result = roots_.asDiagonal() * solver_.solve(roots_.asDiagonal() * balanced);
  removeRigid(result);
  return result;
}

std::vector<Eigen::Index> VibrationProblem::freeRows() const {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < size(); ++k) {
    if (roots_[k] > 0.0) rows.push_back(k);
  }
  return rows;
}

Eigen::MatrixXd VibrationProblem::dense() const {
  std::vector<Eigen::Index> placeOf(static_cast<std::size_t>(size()), -1);
  Eigen::Index count = 0;
  for (const Eigen::Index row : freeRows()) placeOf[static_cast<std::size_t>(row)] = count++;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  const auto sparse = stiffness_.sparse();
  using Sparse = std::remove_const_t<decltype(sparse)>;
  for (Eigen::Index outer = 0; outer < sparse.outerSize(); ++outer) {
    for (typename Sparse::InnerIterator entry(sparse, outer); entry; ++entry) {
      const Eigen::Index i = placeOf[static_cast<std::size_t>(entry.row())];
      const Eigen::Index j = placeOf[static_cast<std::size_t>(entry.col())];
      if (i < 0 || j < 0) continue;
      matrix(i, j) = inverseRoots_[entry.row()] * entry.value() * inverseRoots_[entry.col()];
    }
  }
  return matrix;
}

}  // namespace tetskin::elastic_detail
