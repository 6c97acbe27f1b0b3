// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/dynamics/tet_stretches.h>

#include <array>
#include <cassert>

namespace tetskin::elastic_detail {

std::vector<std::uint32_t> tetNumbers(const RestTets& rest) {
  std::vector<std::uint32_t> numbers;
  const auto put = [&](std::size_t tet, std::size_t number) {
    if (numbers.size() <= tet) numbers.resize(tet + 1, 0);
    numbers[tet] = static_cast<std::uint32_t>(number);
  };
  for (std::size_t t = 0; t < rest.count(); ++t) put(rest.cageTets[t], t);
  for (std::size_t q = 0; q < rest.quadratic.size(); ++q) {
    for (const int tet : rest.quadratic[q].cageTets) put(static_cast<std::size_t>(tet), rest.count() + q);
  }
  return numbers;
}

/// F is linear in the weights of a point: its mean is that at their means.
double TetStretches::length(std::size_t tet, const Eigen::Vector3d& v) const {
  assert(tet < numbers.size());
  const std::size_t number = numbers[tet];
  const bool linear = number < rest.count();
  const RestQuadraticTet* const quadratic = linear ? nullptr : &rest.quadratic[number - rest.count()];
  const std::array<double, 9>& gradients = linear ? rest.gradients[number] : quadratic->gradients;
  std::array<double, 4> slopes{}, weights = {1.0, 0.0, 0.0, 0.0};  // along v, and at the mean of the points
  for (std::size_t k = 0; k < 3; ++k) {
    slopes[k + 1] = Eigen::Vector3d::Map(&gradients[3 * k]).dot(v);
    slopes[0] -= slopes[k + 1];
    for (std::size_t point = 0; point < kQuadraticPoints && !linear; ++point) {
      weights[k + 1] += quadratic->points[3 * point + k] / static_cast<double>(kQuadraticPoints);
    }
    weights[0] -= weights[k + 1];
  }
  Eigen::Vector3d carried = Eigen::Vector3d::Zero();
  const auto add = [&](int node, double slope) {
    carried += slope * Eigen::Vector3d::Map(&places[3 * slotOf[static_cast<std::size_t>(node)]]);
  };
  std::size_t edge = 4;
  for (std::size_t a = 0; a < 4; ++a) {
    if (linear) add(rest.tets[number][a], slopes[a]);
    if (linear) continue;
    add(quadratic->nodes[a], (4.0 * weights[a] - 1.0) * slopes[a]);
    for (std::size_t b = a + 1; b < 4; ++b) {
      add(quadratic->nodes[edge++], 4.0 * (weights[a] * slopes[b] + weights[b] * slopes[a]));
    }
  }
  return carried.norm();
}

}  // namespace tetskin::elastic_detail
