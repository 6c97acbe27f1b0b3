// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin {

/// Lamé's parameters of a material, in the unit of its Young's modulus; Poisson's ratio is below 0.5.
struct Lame {
  double mu;
  double lambda;

  Lame(double youngsModulus, double poissonRatio)
      : mu(youngsModulus / (2.0 * (1.0 + poissonRatio))),
        lambda(youngsModulus * poissonRatio / ((1.0 + poissonRatio) * (1.0 - 2.0 * poissonRatio))) {}
};

}  // namespace tetskin
