// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How much of a pass's step to take, where sliding bends what the pass took for straight.
#include <tetskin/bullet/src/solver/system_solve.h>

#include <cmath>

namespace tetskin {
namespace {

/// Of a line search.
constexpr int kMaxHalvings = 20;
constexpr double kFlat = 0.05;

}  // namespace

/// Of the energy of which the solve seeks the least, along the pass's step.
double SystemSolve::slope(btScalar share, double linear, double quadratic) const {
  double sum = linear + static_cast<double>(share) * quadratic;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    ContactRow::State state{};
    const btVector3 impulse = impulseAt(row, before_[r] + share * stepped_[r], false, state);
    sum -= toEigen(impulse - row.given).dot(toEigen(stepped_[r]));
  }
  return sum;
}

/// How much of the pass's step to take.
btScalar SystemSolve::searchLine() {
  findResiduals();
  const Vector rigidStep = fewStep_.head(rigidSize_);
  double linear = rigidStep.dot(rigidMomentum_ - rigidPush_), quadratic = rigidStep.dot(rigidPush_);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      const auto step = static_cast<double>(matrix.solution()[i] - states_[k].solution[i]);
      const auto before = static_cast<double>(states_[k].residual[i]);
      linear -= step * before;
      quadratic += step * (before - static_cast<double>(matrix.residual()[i]));
    }
  }
  for (const PartUnknown& part : parts_) {
    const Vector6 step = fewStep_.segment<6>(part.first);
    const Vector6 grown = momentumOf(part) - partsBefore_.segment<6>(part.first);
    linear += step.dot(partsBefore_.segment<6>(part.first) - part.began);
    quadratic += step.dot(grown);
  }
  const double first = slope(0, linear, quadratic), all = slope(1, linear, quadratic);
  // A step that does not lead down, by rounding or as bounds are refreshed, has no least on it.
  if (!(first < 0.0 && all > -kFlat * first)) return 1;
  double low = 0.0, high = 1.0, atLow = first, atHigh = all;
  for (int k = 0; k < kMaxHalvings; ++k) {
    const double tried = k % 2 == 1 ? 0.5 * (low + high) : low - atLow * (high - low) / (atHigh - atLow);
    const double here = slope(static_cast<btScalar>(tried), linear, quadratic);
    if (std::abs(here) < kFlat * std::abs(first)) return static_cast<btScalar>(tried);
    (here > 0.0 ? high : low) = tried;
    (here > 0.0 ? atHigh : atLow) = here;
  }
  return static_cast<btScalar>(0.5 * (low + high));
}

void SystemSolve::moveBack(btScalar share) {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    btScalar* solution = matrix.solution();
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      solution[i] = states_[k].solution[i] + share * (solution[i] - states_[k].solution[i]);
    }
  }
  const auto rest = static_cast<double>(1 - share);
  few_ -= rest * fewStep_;
  rigidMomentum_ -= rest * rigidPush_;
  for (btVector3& step : stepped_) step *= share;
}

}  // namespace tetskin
