// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Maps of space with known gradients, which deform cages and predict surfaces.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace tetskin::test {

struct SmoothMap {
  std::string name;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> at;
  std::function<Eigen::Matrix3d(const Eigen::Vector3d&)> gradient;

  std::vector<Eigen::Vector3d> operator()(std::vector<Eigen::Vector3d> points) const;
};

/// About a centre: a twist by 1.5 rad per unit length of x, a bend of x on a circle of radius 1.25, a cubic sag, and
/// waves.
std::vector<SmoothMap> smoothMaps(const Eigen::Vector3d& centre);

/// An affine map with coefficients in [-1, 1], of either orientation.
SmoothMap affineMap(unsigned seed);

/// The identity changed by up to 0.2 in every coefficient, with second derivatives in [-amount, amount].
SmoothMap quadraticMap(unsigned seed, double amount);

/// The map that is the fraction `amount` of the way from the identity to `map`.
SmoothMap partOf(const SmoothMap& map, double amount);

}  // namespace tetskin::test
