// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetskin {

/// An axis-aligned box, empty until extended. NaN extends nothing.
template <class Scalar>
struct BvhBox {
  static constexpr Scalar kFar = std::numeric_limits<Scalar>::max();
  Scalar low[3] = {kFar, kFar, kFar};
  Scalar high[3] = {-kFar, -kFar, -kFar};

  void extend(const Scalar* lower, const Scalar* upper) {
    for (int k = 0; k < 3; ++k) {
      low[k] = lower[k] < low[k] ? lower[k] : low[k];
      high[k] = upper[k] > high[k] ? upper[k] : high[k];
    }
  }
  /// point  its three coordinates
  void extend(const Scalar* point) { extend(point, point); }
  void extend(const BvhBox& b) { extend(b.low, b.high); }

  /// Without branches, because most pairs are disjoint, along no particular axis.
  bool collides(const BvhBox& b) const {
    return (low[0] <= b.high[0]) & (low[1] <= b.high[1]) & (low[2] <= b.high[2]) & (b.low[0] <= high[0]) &
           (b.low[1] <= high[1]) & (b.low[2] <= high[2]);
  }
  BvhBox grownBy(Scalar margin) const {
    BvhBox grown = *this;
    for (int k = 0; k < 3; ++k) {
      grown.low[k] -= margin;
      grown.high[k] += margin;
    }
    return grown;
  }
  BvhBox intersection(const BvhBox& b) const {
    BvhBox common;
    for (int k = 0; k < 3; ++k) {
      common.low[k] = std::max(low[k], b.low[k]);
      common.high[k] = std::min(high[k], b.high[k]);
    }
    return common;
  }
  Scalar diagonal() const {
    const Scalar x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return std::sqrt(x * x + y * y + z * z);
  }

  /// 0 within the box.
  double squaredDistance(const double* point) const {
    double squared = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double below = static_cast<double>(low[k]) - point[k], above = point[k] - static_cast<double>(high[k]);
      const double outside = std::max(std::max(below, above), 0.0);
      squared += outside * outside;
    }
    return squared;
  }

  /// Where a ray enters the box, in units of its direction; infinite if it does not before `end`.
  /// inverse  of the direction's coordinates, infinite for 0
  double entry(const double* start, const double* inverse, double end) const {
    double in = 0.0, out = end;
    for (int k = 0; k < 3; ++k) {
      const double a = (static_cast<double>(low[k]) - start[k]) * inverse[k];
      const double b = (static_cast<double>(high[k]) - start[k]) * inverse[k];
      // With this order of arguments, a ray within a face's plane, which gives NaN here, counts as inside.
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    // A ray that rounding would let pass between two boxes enters both.
    constexpr double kRounding = 1.0 + 1e-14;
    return in <= out * kRounding ? in : std::numeric_limits<double>::infinity();
  }
};

}  // namespace tetskin
