// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Logarithm and exponential function with arithmetic only: the same bits with every C library, errors of some last
// digits of double.
#pragma once

#include <cmath>

namespace tetskin {

/// ln(2).
constexpr double kLog2 = 0.693147180559945309;

/// ln(x) for x > 0, to 1e-14: with x = m 2^k, 2 artanh((m - 1) / (m + 1)) + k ln(2).
inline double portableLog(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.70710678) {
    m *= 2.0;
    --exponent;
  }
  const double z = (m - 1.0) / (m + 1.0), square = z * z;
  double sum = 0.0;
  for (int k = 17; k >= 1; k -= 2) sum = sum * square + 1.0 / k;
  return 2.0 * z * sum + exponent * kLog2;
}

/// exp(x) for |x| < 1000, with a relative error of 1e-16 |x| or a few last digits: with x = r + k ln(2), Taylor's
/// series of r times 2^k.
inline double portableExp(double x) {
  const double whole = std::floor(x / kLog2 + 0.5), r = x - whole * kLog2;
  double sum = 1.0;
  for (int k = 15; k >= 1; --k) sum = 1.0 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(whole));
}

}  // namespace tetskin
