// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The conjugate gradient for one body, or for several coupled bodies. The preconditioner is a symmetric Gauss-Seidel
// sweep of each body, see elastic_kernels.h.
#pragma once

#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <vector>

namespace tetskin::elastic_detail {

/// All norms are the preconditioner's, of impulses: r . P^-1 r.
struct SolveLimits {
  double tolerance = 5e-3;  ///< of the residual relative to what acts
  double acting = 0.0;      ///< squared norm of what acts; 0: that of the residual at the start
  double reduction = 1.0;   ///< required reduction of the residual since the start, in addition
  double enough = 0.0;      ///< a squared norm of the residual that always counts as converged
  int iterations = 200;     ///< bound of their number
};

template <class S>
class TETSKIN_ELASTIC_API ConjugateGradient {
 public:
  using Matrices = std::vector<BlockMatrix<S>*>;
  /// A symmetric positive operator added to the matrices, which may couple them.
  class CouplingOperator {
   public:
    virtual ~CouplingOperator() = default;
    /// Called when the k-th matrix has its `stepPoints`; for several matrices in parallel, on any threads.
    virtual void readPoints(std::size_t k) = 0;
    /// Called after all of them have been read.
    virtual void combine() = 0;
    /// The addition to A t of the k-th matrix, in the wide layout, or null. Called once per matrix, in parallel, on any
    /// threads.
    virtual const S* apply(std::size_t k) = 0;
  };

  /// Starts from the matrices' residuals r = b - A x. They are transformed in place, so call `start` only once.
  /// coupling  null: only the matrices. Not owned, must stay valid while this is used.
  void start(Matrices matrices, const SolveLimits& limits, CouplingOperator* coupling, ParallelFor* threads);
  /// After `start`: the share of the k-th matrix in `squaredResidual`.
  double squaredResidualOf(std::size_t k) const { return partial_[k]; }
  /// After `start`: keeps only some matrices, and leaves the solutions of the others as they are. From then on the
  /// operator is called with the matrices' new numbers.
  /// kept  ascending numbers of matrices, at least one
  void keepOnly(const std::vector<std::size_t>& kept);
  /// Does up to `maximum` iterations; returns true if it has converged. If an operator is not positive, it stops with
  /// the current solution.
  bool iterate(int maximum, ParallelFor* threads);

  bool converged() const { return rho_ <= target_; }
  /// The squared norm of the residual at which it has converged, whatever it was at the start.
  double enough() const { return enough_; }
  /// The current squared norm of the residual.
  double squaredResidual() const { return rho_; }
  int iterations() const { return iterations_; }

 private:
  bool step(ParallelFor* threads);
  void stop();

  template <class Call>
  void forEachMatrix(ParallelFor* threads, Call&& call);
  double summed() const;

  Matrices matrices_;
  std::vector<std::size_t> sizes_;  ///< by matrix
  CouplingOperator* coupling_ = nullptr;
  std::vector<double> partial_;  ///< by matrix
  double rho_ = 0.0, enough_ = 0.0, target_ = 0.0;
  S factor_ = 0;
  int iterations_ = 0, max_ = 0;
  bool stopped_ = false;  ///< an operator is not positive, or a value is not finite
};

}  // namespace tetskin::elastic_detail
