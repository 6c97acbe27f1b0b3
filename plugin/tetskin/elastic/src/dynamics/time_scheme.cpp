// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/dynamics/time_scheme.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Least value of alpha over (1 - a) dt^2. The fastest vibrations change sign from step to step, and become smaller by
/// 1 / this - 1; 1 leaves nothing of them, but makes an undamped beam's error larger by a quarter.
constexpr double kLeast = 0.75;

/// a / (1 - a), the mean lag of H in steps, for a damping of `steps` steps: such that the damping is centred, where
/// this is stable.
double lagFor(double steps) {
  if (steps < 1.0) return std::max(kLeast - steps, 0.0);
  return steps < 2.0 ? 1.0 : steps / (2.0 * (steps - 1.0));
}

}  // namespace

TimeScheme secondOrder(double seconds, double damping) {
  assert(seconds > 0.0 && damping >= 0.0);
  const double lag = lagFor(damping / seconds);
  return {lag / (1.0 + lag), damping};
}

TimeScheme firstOrder(double seconds, double damping) {
  assert(seconds > 0.0 && damping >= 0.0);
  return {damping < seconds ? 1.0 : 0.0, damping};
}

/// With dt^2 / 4, the trapezoidal rule, the forces may be no stiffer than K.
TimeScheme carryingOn(double seconds, double damping, double theta) {
  assert(seconds > 0.0 && damping >= 0.0 && theta >= 0.0 && theta <= 1.0);
  const double half = 0.5 * seconds;
  return {0.0, damping + half, theta * half / (damping + half)};
}

TimeScheme backwardEuler(double seconds, double damping) {
  assert(seconds > 0.0 && damping >= 0.0);
  return {0.0, damping + seconds};
}

}  // namespace tetskin::elastic_detail
