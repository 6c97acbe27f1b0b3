// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/run_by_size.h>
#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace tetskin::elastic_detail {

/// Small matrices are processed in parallel, large ones one after the other, each by all threads.
template <class S>
template <class Call>
void ConjugateGradient<S>::forEachMatrix(ParallelFor* threads, Call&& call) {
  runBySize(
      threads, sizes_, [&](std::size_t k) { return isDivisible(sizes_[k]); },
      [&](std::size_t k, ParallelFor* inner) { partial_[k] = call(k, *matrices_[k], inner); });
}

/// Sums in an order that does not depend on the number of threads.
template <class S>
double ConjugateGradient<S>::summed() const {
  return std::accumulate(partial_.begin(), partial_.end(), 0.0);
}

template <class S>
void ConjugateGradient<S>::start(Matrices matrices, const SolveLimits& limits, CouplingOperator* coupling,
                                 ParallelFor* threads) {
  assert(!matrices.empty() && std::find(matrices.begin(), matrices.end(), nullptr) == matrices.end());
  assert(limits.tolerance >= 0.0 && limits.iterations >= 0);
  matrices_ = std::move(matrices);
  coupling_ = coupling;
  partial_.assign(matrices_.size(), 0.0);
  sizes_.clear();
  for (const BlockMatrix<S>* matrix : matrices_) sizes_.push_back(matrix->slotCount());
  forEachMatrix(threads, [](std::size_t, BlockMatrix<S>& matrix, ParallelFor* inner) { return matrix.lower(inner); });
  rho_ = summed();
  // Below the second of these, products of residuals lose their digits, and the next step lengths would be arbitrary.
  constexpr double kEpsilon = std::numeric_limits<S>::epsilon();
  const double least =
      std::max(limits.enough, static_cast<double>(std::numeric_limits<S>::min()) / (kEpsilon * kEpsilon));
  const double relative = limits.tolerance * limits.tolerance * (limits.acting > 0.0 ? limits.acting : rho_);
  enough_ = std::max(relative, least);
  target_ = std::max(std::min(relative, limits.reduction * limits.reduction * rho_), least);
  stopped_ = false;
  if (!std::isfinite(rho_)) stop();
  factor_ = 0;
  iterations_ = 0;
  max_ = limits.iterations;
}

template <class S>
void ConjugateGradient<S>::keepOnly(const std::vector<std::size_t>& kept) {
  assert(!kept.empty() && kept.back() < matrices_.size() && iterations_ == 0);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    matrices_[k] = matrices_[kept[k]];
    sizes_[k] = sizes_[kept[k]];
    partial_[k] = partial_[kept[k]];
  }
  matrices_.resize(kept.size());
  sizes_.resize(kept.size());
  partial_.resize(kept.size());
  rho_ = summed();
}

template <class S>
bool ConjugateGradient<S>::step(ParallelFor* threads) {
  assert(!stopped_ && partial_.size() == matrices_.size());
  const auto forward = [&](std::size_t k, BlockMatrix<S>& matrix, ParallelFor* inner) {
    return matrix.forward(coupling_ ? coupling_->apply(k) : nullptr, inner);
  };
  forEachMatrix(threads, [&](std::size_t k, BlockMatrix<S>& matrix, ParallelFor* inner) {
    matrix.backward(factor_, inner);
    if (!coupling_) return forward(k, matrix, inner);
    coupling_->readPoints(k);
    return 0.0;
  });
  if (coupling_) {
    coupling_->combine();
    forEachMatrix(threads, forward);
  }
  const double bend = summed();
  // If the operator is not positive, the iteration stops with the current solution.
  if (!(bend > 0.0 && std::isfinite(bend))) return false;
  const auto length = static_cast<S>(rho_ / bend);
  forEachMatrix(threads,
                [&](std::size_t, BlockMatrix<S>& matrix, ParallelFor* inner) { return matrix.advance(length, inner); });
  const double rho = summed();
  factor_ = static_cast<S>(rho / rho_);
  rho_ = rho;
  return true;
}

template <class S>
void ConjugateGradient<S>::stop() {
  stopped_ = true;
  for (BlockMatrix<S>* matrix : matrices_) matrix->clear();
}

template <class S>
bool ConjugateGradient<S>::iterate(int maximum, ParallelFor* threads) {
  for (int k = 0; k < maximum && iterations_ < max_ && !stopped_ && !converged(); ++k, ++iterations_) {
    if (!step(threads)) stop();
  }
  return converged();
}

TETSKIN_INSTANTIATE_CLASS(ConjugateGradient)

}  // namespace tetskin::elastic_detail
