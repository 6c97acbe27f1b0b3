// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/shared/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::elastic_detail {

template <class S>
void ConjugateGradient<S>::start(Matrices matrices, const SolveLimits& limits, Extra extra, ParallelFor* threads) {
  assert(!matrices.empty() && std::find(matrices.begin(), matrices.end(), nullptr) == matrices.end());
  assert(limits.tolerance >= 0.0 && limits.iterations >= 0);
  matrices_ = std::move(matrices);
  extra_ = std::move(extra);
  added_.assign(matrices_.size(), nullptr);
  rho_ = 0.0;
  double mass = 0.0;
  for (BlockMatrix<S>* matrix : matrices_) {
    rho_ += matrix->lower(threads);
    mass += matrix->totalMass();
  }
  target_ = std::max(limits.tolerance * limits.tolerance * rho_, limits.floor * limits.floor * mass);
  target_ = std::max(target_, limits.enough);
  // Below this, products of residuals lose their digits, and the next step lengths would be arbitrary.
  constexpr double kEpsilon = std::numeric_limits<S>::epsilon();
  target_ = std::max(target_, static_cast<double>(std::numeric_limits<S>::min()) / (kEpsilon * kEpsilon));
  stopped_ = false;
  if (!std::isfinite(rho_)) stop();
  factor_ = 0;
  iterations_ = 0;
  max_ = limits.iterations;
}

template <class S>
bool ConjugateGradient<S>::step(ParallelFor* threads) {
  assert(!stopped_ && added_.size() == matrices_.size());
  for (BlockMatrix<S>* matrix : matrices_) matrix->backward(factor_, threads);
  if (extra_) extra_(added_);
  double bend = 0.0;
  for (std::size_t k = 0; k < matrices_.size(); ++k) bend += matrices_[k]->forward(added_[k], threads);
  // If the addition is not positive, the iteration stops with the current solution.
  if (!(bend > 0.0 && std::isfinite(bend))) return false;
  const auto length = static_cast<S>(rho_ / bend);
  double rho = 0.0;
  for (BlockMatrix<S>* matrix : matrices_) rho += matrix->advance(length, threads);
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

#define TETSKIN_INSTANTIATE(Scalar) template class ConjugateGradient<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
