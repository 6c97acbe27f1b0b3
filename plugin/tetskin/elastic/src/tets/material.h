// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/core/types.h>

#include <cassert>
#include <cmath>
#include <cstdio>

namespace tetskin::elastic_detail {

/// Lamé's parameters, in pressure units.
struct Lame {
  double mu = 0.0;      ///< above 0
  double lambda = 0.0;  ///< at least 0
};

/// youngsModulus  in pressure units, above 0
/// poissonRatio   0 to below 0.5
inline Lame lameOf(double youngsModulus, double poissonRatio) {
  assert(youngsModulus > 0.0 && poissonRatio >= 0.0 && poissonRatio < 0.5);
  return {youngsModulus / (2.0 * (1.0 + poissonRatio)),
          youngsModulus * poissonRatio / ((1.0 + poissonRatio) * (1.0 - 2.0 * poissonRatio))};
}

/// The largest Poisson's ratio. Beyond it, resistance to a change of volume exceeds that to a change of shape so far
/// that the rounding of the former is as large as the latter: landing balls have exploded from 0.49999 on in float, and
/// solves take hundreds of iterations.
template <class Scalar>
constexpr double kMaxPoissonRatio = sizeof(Scalar) == sizeof(float) ? 0.4999 : 0.499999;

/// Ok, or says what is invalid in a material, or beyond the range of Scalar.
/// damping  seconds
template <class Scalar>
Status checkMaterial(double youngsModulus, double poissonRatio, double damping) {
  const auto invalid = [](const char* message) { return Status{StatusCode::InvalidOption, message}; };
  const auto held = [](double value) { return std::isfinite(static_cast<Scalar>(value)); };
  if (!(youngsModulus > 0.0 && std::isfinite(youngsModulus))) {
    return invalid("Young's modulus must be finite and above 0");
  }
  if (!(poissonRatio >= 0.0 && poissonRatio < 0.5)) {
    return invalid("Poisson's ratio must be at least 0 and below 0.5");
  }
  if (poissonRatio > kMaxPoissonRatio<Scalar>) {
    return invalid(sizeof(Scalar) == sizeof(float) ? "Poisson's ratio may be at most 0.4999 in float"
                                                   : "Poisson's ratio may be at most 0.499999 in double");
  }
  if (!(damping >= 0.0 && std::isfinite(damping))) return invalid("damping must be finite and not negative");
  const Lame lame = lameOf(youngsModulus, poissonRatio);
  if (held(lame.mu) && held(lame.lambda) && held(damping) && held(lame.lambda * damping)) return {};
  return invalid(sizeof(Scalar) == sizeof(float)
                     ? "the material is too stiff, or too strongly damped, for the range of float"
                     : "the material is too stiff, or too strongly damped, for the range of double");
}

/// Bound of Young's modulus over density and over squared size, in 1 / s^2. Above it, the rounding of positions in this
/// precision stores more energy than a falling or rotating body has. Tested to be stable up to this value, in steps of
/// 1/60 s.
template <class Scalar>
constexpr double kMaxStiffness = sizeof(Scalar) == sizeof(float) ? 1e12 : 1e16;

/// True if a body with this ratio of stiffness to mass can be simulated.
/// youngsModulus  with what fibres add to it
/// volume         at rest; its cube root counts as the size
template <class Scalar>
Status checkStiffness(double youngsModulus, double damping, double mass, double volume, bool withFibres = false) {
  // Seconds. Damping adds stiffness times damping over the step to the matrix; the limit was tested in steps of this
  // length.
  constexpr double kLongStep = 1.0 / 60.0;
  const double size = cubeRoot(volume), density = mass / volume;
  const double maximum = kMaxStiffness<Scalar> * density * size * size / (1.0 + damping / kLongStep);
  if (!(mass > 0.0 && volume > 0.0) || youngsModulus <= maximum) return {};
  char text[256];
  std::snprintf(
      text, sizeof text,
      "a Young's modulus of %.3g with %sdamping of %.3g s is too stiff for a mass of %.3g in a volume of %.3g, "
      "in %s: at most %.3g",
      youngsModulus, withFibres ? "these fibres and " : "", damping, mass, volume,
      sizeof(Scalar) == sizeof(float) ? "float" : "double", maximum);
  return {StatusCode::InvalidOption, text};
}

}  // namespace tetskin::elastic_detail
