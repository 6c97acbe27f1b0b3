// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Functions whose last bits differ between C libraries, here computed with arithmetic and square roots only: steps have
// the same bits everywhere. Errors are a few last digits of double.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {

struct SineAndCosine {
  double sine = 0.0, cosine = 1.0;
};

/// x  radians, below 1e6 in magnitude: the error grows with it
inline SineAndCosine sineAndCosine(double x) {
  assert(std::abs(x) < 1e6);
  // A quarter turn in two parts; whole multiples of the first are exact.
  constexpr double kQuarter = 1.57079632673412561417, kQuarterRest = 6.07710050650619224932e-11;
  const double quarters = std::floor(x / kQuarter + 0.5);
  const double r = (x - quarters * kQuarter) - quarters * kQuarterRest, rr = r * r;
  double sine = 0.0, cosine = 0.0;  // Taylor's series, from their last terms
  for (int k = 19; k >= 3; k -= 2) sine = (sine + 1.0) * (-rr / (k * (k - 1)));
  for (int k = 18; k >= 2; k -= 2) cosine = (cosine + 1.0) * (-rr / (k * (k - 1)));
  sine = r + r * sine;
  cosine += 1.0;
  switch (static_cast<int>(quarters - 4.0 * std::floor(quarters / 4.0))) {
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    case 3:
      return {-cosine, sine};
    default:
      return {sine, cosine};
  }
}

/// Radians, from -pi/2 to pi/2; near both ends, its error is some ten last digits.
/// sine  from -1 to 1
inline double arcSine(double sine) {
  assert(std::abs(sine) <= 1.0);
  // The sine of an eighth of the angle, which is at most 0.2: sin(a / 2) = sin(a) / sqrt(2 (1 + cos(a))).
  double part = sine;
  for (int k = 0; k < 3; ++k) part /= std::sqrt(2.0 * (1.0 + std::sqrt(std::max(0.0, 1.0 - part * part))));
  const double square = part * part;
  double sum = 0.0;  // the series, from its last term
  for (int k = 23; k >= 1; k -= 2) sum = square * k / (k + 1) * (1.0 / (k + 2) + sum);
  return 8.0 * (part + part * sum);
}

/// The cube root of a number of 0 or more.
inline double cubeRoot(double x) {
  assert(x >= 0.0);
  if (!(x > 0.0) || !std::isfinite(x)) return x;
  int exponent = 0;
  const double whole = std::frexp(x, &exponent);  // 0.5 to 1
  const int third = (exponent >= 0 ? exponent + 2 : exponent) / 3;
  const double target = std::ldexp(whole, exponent - 3 * third);  // 1/16 to 1
  double root = 0.4 + 0.6 * target;
  for (int k = 0; k < 6; ++k) root = (2.0 * root + target / (root * root)) / 3.0;  // Newton's method
  return std::ldexp(root, third);
}

}  // namespace tetskin
