// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The greatest and the least of many values. One that is not a number stays: no later value hides an explosion.
#pragma once

#include <cmath>

namespace tetskin::contact_demo {

inline void raise(double& most, double value) {
  if (!(value <= most) && !std::isnan(most)) most = value;
}

inline void lower(double& least, double value) {
  if (!(value >= least) && !std::isnan(least)) least = value;
}

}  // namespace tetskin::contact_demo
