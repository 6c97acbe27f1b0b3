// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: how much of a step to take along which an energy falls at first.
#pragma once

#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {

/// The fraction at which the energy falls no more, up to a twentieth of its fall at the beginning, by regula falsi and
/// bisection in turn. 1 if it falls on all of the step; and if it does not fall at first, because of rounding or
/// because bounds are refreshed: there is no minimum on the step then.
/// slope  (double fraction) -> double: the derivative of the energy by the fraction; ascending
/// Cost   at most 22 calls
template <class Slope>
double stepFraction(Slope&& slope) {
  constexpr int kMaxHalvings = 20;
  constexpr double kFlat = 0.05;
  const double first = slope(0.0), all = slope(1.0);
  if (!(first < 0.0 && all > -kFlat * first)) return 1.0;
  double low = 0.0, high = 1.0, atLow = first, atHigh = all;
  for (int k = 0; k < kMaxHalvings; ++k) {
    const double tried = k % 2 == 1 ? 0.5 * (low + high) : low - atLow * (high - low) / (atHigh - atLow);
    assert(tried >= low && tried <= high);
    const double here = slope(tried);
    if (std::abs(here) < kFlat * std::abs(first)) return tried;
    (here > 0.0 ? high : low) = tried;
    (here > 0.0 ? atHigh : atLow) = here;
  }
  return 0.5 * (low + high);
}

}  // namespace tetskin::bullet_detail
