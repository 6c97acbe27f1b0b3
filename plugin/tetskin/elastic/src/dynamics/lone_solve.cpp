// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/impulse_history.h>
#include <tetskin/elastic/src/dynamics/lone_solve.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace tetskin::elastic_detail {
namespace {

/// Least bound of the iterations of a solve that is continued in two levels: with a lower one it must be cheap.
constexpr int kPatience = 50;
/// Number of solves after which the conjugate gradient is tried alone again.
constexpr int kTwoLevelSolves = 240;

}  // namespace

template <class S>
void LoneSolve<S>::beginStep(const BlockMatrix<S>& matrix) {
  if (guess_.isUsed()) guess_.remember(matrix);
}

template <class S>
int LoneSolve<S>::solve(const LoneSystem<S>& system, ConjugateGradient<S>& gradient, SolveLimits limits, int maximum,
                        ParallelFor* threads) {
  assert(maximum >= 0 && system.rightSide.size() == system.matrix.wideSize());
  const bool guesses = maximum > 0;
  if (guesses) guess_.improve(system.matrix, limits, threads);
  if (guesses && twoLevelSolves_ > 0) return solveInTwoLevels(system, gradient, limits, threads);
  gradient.start({&system.matrix}, limits, nullptr, threads);
  const double squared = gradient.squaredResidual();
  gradient.iterate(maximum, threads);
  const int iterations = gradient.iterations();
  if (guesses) guess_.learn(squared, limits.acting, iterations);
  const bool ended = iterations < limits.iterations || gradient.squaredResidual() <= gradient.enough();
  if (ended || limits.iterations < kPatience) return iterations;
  twoLevelSolves_ = kTwoLevelSolves;
  return iterations + solveInTwoLevels(system, gradient, limits, threads);
}

template <class S>
int LoneSolve<S>::solveInTwoLevels(const LoneSystem<S>& system, ConjugateGradient<S>& gradient, SolveLimits limits,
                                   ParallelFor* threads) {
  assert(twoLevelSolves_ > 0);
  --twoLevelSolves_;
  BlockMatrix<S>& matrix = system.matrix;
  const RestTets& rest = system.tets.rest();
  if (!twoLevels_) twoLevels_ = std::make_unique<TwoLevelGradient<S>>(rest, matrix);
  std::vector<double> points(3 * matrix.slotCount());
  for (std::size_t slot = 0; slot < matrix.slotCount(); ++slot) {
    std::copy_n(system.places.at(slot), 3, &points[3 * slot]);
  }
  const double relative = limits.tolerance * limits.tolerance * limits.acting;
  const double target = std::max({relative, limits.enough, static_cast<double>(std::numeric_limits<S>::min())});
  const S* corners = system.tets.cornersAgain(static_cast<S>(system.alpha), threads);
  const int iterations = twoLevels_->solve(
      matrix, {rest, corners, static_cast<double>(system.tets.ratio()), system.spread, system.tets.fibreLayers()},
      system.rightSide.data(), points, target, limits.iterations, threads);
  // What is left is measured, and stays.
  limits.reduction = 1.0;
  limits.iterations = 0;
  gradient.start({&matrix}, limits, nullptr, threads);
  return iterations;
}

template <class S>
void LoneSolve<S>::turn(const std::array<double, 9>& turn, const std::vector<std::uint32_t>& partOf) {
  for (AlignedVector<S>* solution : guess_.known()) {
    if (solution) turnWide(solution->data(), {turn}, partOf);
  }
}

template <class S>
void LoneSolve<S>::serialize(StateStream& stream, BlockMatrix<S>& matrix) {
  guess_.serialize(stream, matrix);
  stream(twoLevelSolves_);
}

TETSKIN_INSTANTIATE_CLASS(LoneSolve)

}  // namespace tetskin::elastic_detail
