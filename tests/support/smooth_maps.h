// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Maps of space with known gradients, to deform cages by and to compare surfaces with.
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

/// Twist by 1.5 rad per unit length of x, bend of x on a circle of radius 1.25, cubic sag and waves, about a centre.
std::vector<SmoothMap> smoothMaps(const Eigen::Vector3d& centre);

/// Affine, with coefficients in [-1, 1], of either orientation.
SmoothMap affineMap(unsigned seed);

/// The identity changed by up to 0.2 in every coefficient, with second derivatives in [-amount, amount].
SmoothMap quadraticMap(unsigned seed, double amount);

/// The part `amount` of the way from the identity to a map.
SmoothMap partOf(const SmoothMap& map, double amount);

}  // namespace tetskin::test
