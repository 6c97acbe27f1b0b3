// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/initial_guess.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// The solve must reduce the residual that a guess leaves at least to this fraction.
constexpr double kReduction = 0.1;
/// A guess is worth its cost if a solve has at least this many iterations.
constexpr int kMany = 8;
/// A guess that leaves more than this fraction of what acts is useless. After kUselessGuesses of these in a row, kPause
/// solves start without a guess.
constexpr double kUseless = 0.25;
constexpr int kUselessGuesses = 8, kPause = 64;
/// Combinations of unit directions whose squared length is below this are only rounding.
constexpr double kDependent = 1e-6;

}  // namespace

template <class S>
void InitialGuess<S>::remember(const BlockMatrix<S>& matrix) {
  std::swap(last_, before_);
  last_.assign(matrix.solution(), matrix.solution() + matrix.wideSize());
  known_ = std::min<std::size_t>(known_ + 1, 2);
}

template <class S>
void InitialGuess<S>::improve(BlockMatrix<S>& matrix, SolveLimits& limits, ParallelFor* threads) {
  improved_ = used_ && known_ > 0;
  if (!improved_) return;
  assert(last_.size() == matrix.wideSize());
  limits.reduction = kReduction;
  start_.assign(matrix.solution(), matrix.solution() + matrix.wideSize());
  count_ = 0;
  addDirection(matrix, last_, start_.data(), threads);
  addDirection(matrix, last_, nullptr, threads);
  if (known_ > 1) addDirection(matrix, last_, before_.data(), threads);
  const Factors factors = bestFactors(matrix, threads);
  S *solution = matrix.solution(), *residual = matrix.residual();
  for (std::size_t k = 0; k < count_; ++k) {
    const auto factor = static_cast<S>(factors[k]);
    const S *direction = directions_[k].data(), *image = images_[k].data();
    if (factor == S(0)) continue;  // they may not be finite
    for (std::size_t i = 0; i < start_.size(); ++i) {
      solution[i] += factor * direction[i];
      residual[i] -= factor * image[i];
    }
  }
}

/// The direction is the difference of two vectors; null: 0.
template <class S>
void InitialGuess<S>::addDirection(BlockMatrix<S>& matrix, const Wide& first, const S* second, ParallelFor* threads) {
  assert(count_ < kDirections && first.size() == matrix.wideSize());
  Wide &direction = directions_[count_], &image = images_[count_];
  direction.resize(matrix.wideSize());
  image.resize(matrix.wideSize());
  matrix.multiplyDifference(first.data(), second, direction.data(), image.data(), threads);
  ++count_;
}

/// Uses the eigenvectors of the products of directions, which are nearly dependent in smooth motion. 0 if the values
/// are not finite.
template <class S>
typename InitialGuess<S>::Factors InitialGuess<S>::bestFactors(BlockMatrix<S>& matrix, ParallelFor* threads) const {
  constexpr auto kSize = static_cast<Eigen::Index>(kDirections);
  using Vector = Eigen::Matrix<double, kSize, 1>;
  Eigen::Matrix<double, kSize, kSize> products = Eigen::Matrix<double, kSize, kSize>::Zero();
  Vector right = Vector::Zero(), scales = Vector::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k <= i; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      products(row, column) = products(column, row) = matrix.inner(directions_[k].data(), images_[i].data(), threads);
    }
    right[row] = matrix.inner(directions_[i].data(), matrix.residual(), threads);
    if (products(row, row) > 0.0) scales[row] = 1.0 / std::sqrt(products(row, row));
  }
  products = (scales.asDiagonal() * products * scales.asDiagonal()).eval();
  right = scales.cwiseProduct(right).eval();
  Factors factors{};
  if (!products.allFinite() || !right.allFinite()) return factors;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> eigen(products);
  Vector found = Vector::Zero();
  for (Eigen::Index k = 0; k < kSize; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (value > kDependent) found += eigen.eigenvectors().col(k) * (eigen.eigenvectors().col(k).dot(right) / value);
  }
  for (std::size_t k = 0; k < kDirections; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    factors[k] = scales[row] * found[row];
  }
  return factors;
}

template <class S>
void InitialGuess<S>::learn(double squared, double acting, int iterations) {
  if (!used_) {
    pause_ = std::max(pause_ - 1, 0);
    used_ = pause_ == 0 && iterations >= kMany;
    return;
  }
  if (improved_) useless_ = squared > kUseless * kUseless * acting ? useless_ + 1 : 0;
  if (useless_ < kUselessGuesses) return;
  used_ = false;
  useless_ = 0;
  known_ = 0;
  pause_ = kPause;
}

template <class S>
void InitialGuess<S>::serialize(StateStream& stream, BlockMatrix<S>& matrix) {
  stream(used_);
  stream(useless_);
  stream(pause_);
  auto known = static_cast<std::uint32_t>(known_);
  stream(known);
  if (stream.restoring()) known_ = std::min(known, 2u);
  if (!used_) return;
  const auto visit = [&](Wide& solution) {
    if (stream.restoring()) solution.resize(matrix.wideSize());
    matrix.serializeWide(stream, solution.data());
  };
  if (known_ > 0) visit(last_);
  if (known_ > 1) visit(before_);
}

TETSKIN_INSTANTIATE_CLASS(InitialGuess)

}  // namespace tetskin::elastic_detail
