// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/calibration/rest_body.h>
#include <tetskin/elastic/src/modes/dense_factors.h>
#include <tetskin/elastic/src/modes/start_vectors.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// Mass-proportional stiffness that is added for the solve, relative to the mean ratio of stiffness to mass: rigid
/// motions have no stiffness, so the matrix would be singular. They are removed from every result, so the addition only
/// has to be small compared with the softest vibration.
constexpr double kShift = 1e-9;
/// Extra vectors of the subspace: the more, the faster it converges.
constexpr int kGuardModes = 6;
constexpr int kMaxIterations = 20;
/// Relative change of the squared frequencies at which the wanted ones count as converged.
constexpr double kConverged = 1e-4;

Eigen::SparseMatrix<double> shifted(const RestBody& body) {
  Eigen::SparseMatrix<double> matrix = body.stiffness;
  const double shift = kShift * body.stiffness.diagonal().sum() / body.masses.sum();
  matrix.diagonal() += shift * body.masses;
  return matrix;
}

}  // namespace

RestBody::RestBody(const Cage& cage, double poissonRatio, const std::vector<double>& scale, Eigen::VectorXd nodeMasses)
    : stiffness(BlockRows(cage, poissonRatio, scale).sparse().triangularView<Eigen::Lower>()),
      masses(std::move(nodeMasses)),
      rigid(cage.mesh, masses) {}

DirectSolver::DirectSolver(const RestBody& body) : body_(body), factors_(shifted(body)) {}

Fields DirectSolver::solve(const Fields& loads) const {
  assert(ok() && loads.rows() == body_.masses.size());
  Fields displacements(loads.rows(), loads.cols());
  for (Eigen::Index k = 0; k < loads.cols(); ++k) {
    displacements.col(k) = factors_.solve(Eigen::VectorXd(loads.col(k)));
  }
  body_.rigid.removeFrom(displacements);
  return displacements;
}

Eigen::MatrixXd softestModes(const RestBody& body, const DirectSolver& solver, int count) {
  assert(solver.ok() && count > 0);
  const Eigen::Index size = body.masses.size();
  const Eigen::Index columns = std::min<Eigen::Index>(count + kGuardModes, size);
  const Eigen::Index wanted = std::min<Eigen::Index>(count, columns);
  Eigen::MatrixXd modes = startVectors(size, columns);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(wanted);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Fields loads = body.masses.asDiagonal() * modes;
    body.rigid.balance(loads);
    modes = solver.solve(loads);
    // Rayleigh-Ritz: the eigenvectors of the body within the subspace.
    const Eigen::MatrixXd forces = body.stiffness.selfadjointView<Eigen::Lower>() * modes;
    const Eigen::MatrixXd stiffness = modes.transpose() * forces;
    const Eigen::MatrixXd mass = modes.transpose() * body.masses.asDiagonal() * modes;
    const Eigenpairs ritz = eigenpairsOf(stiffness, mass);
    modes *= ritz.vectors;
    const Eigen::VectorXd now = ritz.values.head(wanted);
    if (((now - before).array().abs() <= kConverged * now.array()).all()) break;
    before = now;
  }
  return modes.leftCols(wanted);
}

}  // namespace tetskin::elastic_detail
