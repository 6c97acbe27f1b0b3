// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The fraction of a pass's step to take: sliding is nonlinear, and the pass has linearized it.
#include <tetskin/bullet/src/system/system_solve.h>

#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Most halvings of the interval in a line search.
constexpr int kMaxHalvings = 20;
constexpr double kFlat = 0.05;

}  // namespace

/// The derivative, along the pass's step, of the energy that the solve minimizes.
double SystemSolve::slope(btScalar fraction, double linear, double quadratic) const {
  assert(before_.size() == system_.rows.size() && stepped_.size() == system_.rows.size());
  double sum = linear + static_cast<double>(fraction) * quadratic;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    ContactRow::State state{};
    const btVector3 impulse = impulseAt(row, before_[r] + fraction * stepped_[r], false, state);
    sum -= toEigen(impulse - row.given).dot(toEigen(stepped_[r]));
  }
  return sum;
}

/// The fraction of the pass's step to take.
btScalar SystemSolve::searchLine() {
  findResiduals();
  const Vector rigidStep = reducedStep_.head(rigidSize_);
  double linear = rigidStep.dot(rigidMomentum_ - rigidPush_), quadratic = rigidStep.dot(rigidPush_);
  forEachBody([](Body& body, ParallelFor*) {
    const auto& matrix = body.matrix();
    const btScalar *solution = matrix.solution(), *residual = body.matrix().residual();
    body.linear = body.quadratic = 0.0;
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      const auto step = static_cast<double>(solution[i] - body.solution[i]);
      const auto before = static_cast<double>(body.residual[i]);
      body.linear -= step * before;
      body.quadratic += step * (before - static_cast<double>(residual[i]));
    }
  });
  for (const Body& body : bodies_) {
    linear += body.linear;
    quadratic += body.quadratic;
  }
  for (const ComponentUnknown& component : components_) {
    const Vector6 step = reducedStep_.segment<6>(component.first);
    const Vector6 grown = momentumOf(component) - partsBefore_.segment<6>(component.first);
    linear += step.dot(partsBefore_.segment<6>(component.first) - component.began);
    quadratic += step.dot(grown);
  }
  const double first = slope(0, linear, quadratic), all = slope(1, linear, quadratic);
  // A step along which the energy does not fall, because of rounding or because bounds are refreshed, has no minimum on
  // it.
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

void SystemSolve::moveBack(btScalar fraction) {
  assert(fraction >= 0 && fraction <= 1);
  forEachBody([&](Body& body, ParallelFor*) {
    btScalar* solution = body.matrix().solution();
    for (std::size_t i = 0; i < body.matrix().wideSize(); ++i) {
      solution[i] = body.solution[i] + fraction * (solution[i] - body.solution[i]);
    }
    readSolution(body);
  });
  const auto rest = static_cast<double>(1 - fraction);
  reduced_ -= rest * reducedStep_;
  rigidMomentum_ -= rest * rigidPush_;
  for (btVector3& step : stepped_) step *= fraction;
}

}  // namespace tetskin::bullet_detail
