// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The conjugate gradient over the bodies that something couples, or over one: preconditioned by a symmetric
// Gauss-Seidel sweep of each, see elastic_kernels.h.
#pragma once

#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <functional>
#include <vector>

namespace tetskin::elastic_detail {

struct SolveLimits {
  double tolerance = 5e-3;  ///< of the residual, over that at the start, in the preconditioner's norm
  double floor = 0.0;       ///< an error in velocity that is always small enough
  double enough = 0.0;      ///< a residual, as `enough()`, that is
  int iterations = 200;     ///< at most
};

template <class S>
class TETSKIN_ELASTIC_API ConjugateGradient {
 public:
  using Matrices = std::vector<BlockMatrix<S>*>;
  /// Told when all matrices have their `stepPoints`: for each matrix, what is to be added to A t, wide, or null.
  using Extra = std::function<void(std::vector<const S*>&)>;

  /// Of the matrices' residuals, r = b - A x of their solutions. They are transformed: start once.
  /// extra  a symmetric, positive addition to the matrices; none: each matrix alone. Valid as long as this is used.
  void start(Matrices matrices, const SolveLimits& limits, Extra extra, ParallelFor* threads);
  /// Goes on for so many iterations, or until it has converged; returns whether it has. Where an addition is not
  /// positive it stops, with what it has reached.
  bool iterate(int most, ParallelFor* threads);

  bool converged() const { return rho_ <= target_; }
  /// The square of the residual's norm at which it has.
  double enough() const { return target_; }
  /// The square of the residual's norm, as it is.
  double squaredResidual() const { return rho_; }
  int iterations() const { return iterations_; }

 private:
  bool step(ParallelFor* threads);
  void stop();

  Matrices matrices_;
  Extra extra_;
  std::vector<const S*> added_;
  double rho_ = 0.0, target_ = 0.0;
  S factor_ = 0;
  int iterations_ = 0, most_ = 0;
  bool stopped_ = false;  ///< by an addition that is not positive, or what is not finite
};

}  // namespace tetskin::elastic_detail
