// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Andrew Knyazev, "Toward the Optimal Preconditioned Eigensolver: Locally Optimal Block Preconditioned Conjugate
//     Gradient Method", SIAM J. Sci. Comput. 23, 2001, doi 10.1137/S1064827500366124
//   Ulrich Hetmaniuk, Rich Lehoucq, "Basis selection in LOBPCG", J. Comput. Phys. 218, 2006 (all bases orthonormal)
//   Andreas Stathopoulos, Kesheng Wu, "A Block Orthogonalization Procedure with Constant Synchronization Requirements",
//     SIAM J. Sci. Comput. 23, 2002 (by the eigenvectors of the products)
#include <tetskin/core/src/base/progress.h>
#include <tetskin/elastic/src/modes/dense_factors.h>
#include <tetskin/elastic/src/modes/softest_vibrations.h>
#include <tetskin/elastic/src/modes/start_vectors.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// Relative error of a vector, in the energy norm, at which it counts as converged: the relative error of its
/// eigenvalue is the square of this, up to rounding.
constexpr double kVectorTolerance = 1e-8;
constexpr int kMaxModeIterations = 200;
/// Extra vectors: the more, the faster the wanted ones converge.
constexpr int kGuards = 5;
/// Degrees of freedom per vector below which all vectors are computed at once: the iteration needs three subspaces.
constexpr Eigen::Index kFewFreedoms = 5;
/// Eigenvalue of the products of normalised vectors below which the vectors are linearly dependent.
constexpr double kDependent = 1e-13;

struct Space {
  Fields vectors, images;  ///< images: the matrix times the vectors
};

/// Orthonormal vectors of the same span; drops linearly dependent ones.
Fields orthonormal(Fields vectors) {
  for (int pass = 0; pass < 2 && vectors.cols() > 0; ++pass) {
    Eigen::MatrixXd products = vectors.transpose() * vectors;
    const Eigen::VectorXd scale = products.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    products = scale.asDiagonal() * products * scale.asDiagonal();
    const Eigenpairs eigen = eigenpairsOf(products);
    const Eigen::Index dropped = (eigen.values.array() < kDependent * eigen.values.maxCoeff()).count();
    const Eigen::Index kept = vectors.cols() - dropped;
    vectors = (vectors * (scale.asDiagonal() * eigen.vectors.rightCols(kept) *
                          eigen.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal()))
                  .eval();
  }
  return vectors;
}

Fields picked(const Fields& from, const std::vector<Eigen::Index>& columns) {
  Fields result(from.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) result.col(static_cast<Eigen::Index>(k)) = from.col(columns[k]);
  return result;
}

/// The number of vectors; for bodies with few degrees of freedom, all of them.
Eigen::Index widthFor(const VibrationProblem& problem, int wanted) {
  const Eigen::Index all = problem.freedoms() - problem.rigidCount(), width = wanted + std::max(kGuards, wanted / 4);
  return problem.freedoms() < kFewFreedoms * width ? all : width;
}

class Iteration {
 public:
  Iteration(const VibrationProblem& problem, int wanted)
      : problem_(problem), wanted_(wanted), width_(widthFor(problem, wanted)) {
    // By reflections, which keep all columns: those of slender bodies are nearly linearly dependent.
    const Fields start = startVectors(problem.size(), width_);
    space_.vectors = orthonormalColumns(isComplete() ? problem.possible(start) : problem.precondition(start));
    space_.images = problem.times(space_.vectors);
    rotate();
  }

  /// True if the first vectors span the whole space: then they are the solution.
  bool isComplete() const { return width_ == problem_.freedoms() - problem_.rigidCount(); }

  /// Returns how far the wanted vectors are from their tolerance, at most 1; 0: all have converged.
  double advance() {
    const Fields residuals = space_.vectors.leftCols(width_) * (-values_).asDiagonal() + space_.images.leftCols(width_);
    const Fields steps = problem_.precondition(residuals);
    const Eigen::VectorXd errors =
        (residuals.cwiseProduct(steps).colwise().sum().transpose().cwiseMax(0.0).cwiseQuotient(values_)).cwiseSqrt();
    std::vector<Eigen::Index> active;
    double left = 0.0;
    for (Eigen::Index k = 0; k < width_; ++k) {
      if (!(errors[k] > kVectorTolerance)) continue;
      active.push_back(k);
      if (k < wanted_)
        left += std::clamp(std::log(errors[k] / kVectorTolerance) / std::log(1.0 / kVectorTolerance), 0.01, 1.0);
    }
    if (left > 0.0) extend(picked(steps, active), active);
    return left / wanted_;
  }

  const Eigen::VectorXd& values() const { return values_; }
  Fields vectors() const { return space_.vectors.leftCols(wanted_); }

 private:
  /// Rayleigh-Ritz in the span of the first `width_` vectors.
  void rotate() {
    const Eigen::MatrixXd energies = space_.vectors.transpose() * space_.images;
    take(eigenpairsOf(0.5 * (energies + energies.transpose())), {});
  }

  /// Finds the best vectors in the span of the present ones, of the directions of the last step, and of the new steps.
  void extend(Fields steps, const std::vector<Eigen::Index>& active) {
    assert(steps.cols() == static_cast<Eigen::Index>(active.size()));
    for (int pass = 0; pass < 2; ++pass) {
      steps = orthonormal(std::move(steps));
      problem_.removeRigid(steps);
      steps -= space_.vectors * (space_.vectors.transpose() * steps);
    }
    steps = orthonormal(std::move(steps));
    const Fields images = problem_.times(steps);
    const Eigen::Index before = space_.vectors.cols();
    space_.vectors.conservativeResize(Eigen::NoChange, before + steps.cols());
    space_.images.conservativeResize(Eigen::NoChange, before + steps.cols());
    space_.vectors.rightCols(steps.cols()) = steps;
    space_.images.rightCols(steps.cols()) = images;
    const Eigen::MatrixXd energies = space_.vectors.transpose() * space_.images;
    take(eigenpairsOf(0.5 * (energies + energies.transpose())), active);
  }

  /// The softest Ritz vectors become the present ones; for the active ones, keeps their difference from the former ones
  /// as the direction.
  void take(const Eigenpairs& ritz, const std::vector<Eigen::Index>& active) {
    const Eigen::Index all = space_.vectors.cols();
    assert(ritz.vectors.rows() == all && width_ <= all);
    const Eigen::MatrixXd best = ritz.vectors.leftCols(width_);
    values_ = ritz.values.head(width_);
    Eigen::MatrixXd came(all, static_cast<Eigen::Index>(active.size()));
    for (std::size_t k = 0; k < active.size(); ++k) came.col(static_cast<Eigen::Index>(k)) = best.col(active[k]);
    came.topRows(std::min(width_, all)).setZero();
    for (int pass = 0; pass < 2; ++pass) {
      came -= best * (best.transpose() * came);
      came = orthonormal(Fields(came));
    }
    Eigen::MatrixXd change(all, width_ + came.cols());
    change << best, came;
    space_.vectors = (space_.vectors * change).eval();
    space_.images = (space_.images * change).eval();
  }

  const VibrationProblem& problem_;
  Eigen::Index wanted_, width_;
  Space space_;  ///< the present vectors, followed by the directions of the last step
  Eigen::VectorXd values_;
};

}  // namespace

Vibrations softestVibrations(const VibrationProblem& problem, int count, const std::function<void(double)>& progress) {
  assert(problem.ok() && count > 0 && count <= problem.freedoms() - problem.rigidCount());
  const auto tell = [&](double fraction) {
    if (progress) progress(fraction);
  };
  Iteration iteration(problem, count);
  Vibrations result;
  result.converged = iteration.isComplete();
  double told = 0.0;
  if (result.converged) tell(1.0);
  while (!result.converged && result.iterations < kMaxModeIterations) {
    Progress::goOnWithRound();
    const double left = iteration.advance();
    result.converged = left == 0.0;
    ++result.iterations;
    told = std::max(told, 1.0 - left);
    tell(told);
  }
  result.eigenvalues = iteration.values().head(count);
  result.vectors = iteration.vectors();
  return result;
}

}  // namespace tetskin::elastic_detail
