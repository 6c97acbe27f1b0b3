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

Eigen::MatrixXd VibrationProblem::dense() const {
  return inverseRoots_.asDiagonal() * Eigen::MatrixXd(stiffness_.sparse()) * inverseRoots_.asDiagonal();
}

}  // namespace tetskin::elastic_detail
