// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The greatest and the least of many values, and the one farthest from 0. NaN is kept: no later value hides an
// explosion.
#pragma once

#include <cmath>

namespace tetskin::measure {

inline void raise(double& maximum, double value) {
  if (!(value <= maximum) && !std::isnan(maximum)) maximum = value;
}

inline void lower(double& minimum, double value) {
  if (!(value >= minimum) && !std::isnan(minimum)) minimum = value;
}

inline void raiseMagnitude(double& farthest, double value) {
  if (!(std::abs(value) <= std::abs(farthest)) && !std::isnan(farthest)) farthest = value;
}

}  // namespace tetskin::measure
