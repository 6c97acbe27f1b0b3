// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The greatest and the least of many values. NaN is kept: no later value hides an explosion.
#pragma once

#include <cmath>

namespace tetskin::contact_demo {

inline void raise(double& maximum, double value) {
  if (!(value <= maximum) && !std::isnan(maximum)) maximum = value;
}

inline void lower(double& minimum, double value) {
  if (!(value >= minimum) && !std::isnan(minimum)) minimum = value;
}

}  // namespace tetskin::contact_demo
