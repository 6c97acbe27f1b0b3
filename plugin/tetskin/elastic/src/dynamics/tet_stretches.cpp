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
  const std::array<double, 4> slopes = weightSlopes(gradients, v);
  Eigen::Vector3d carried = Eigen::Vector3d::Zero();
  const auto add = [&](int node, double slope) {
    carried += slope * Eigen::Vector3d::Map(&places[3 * slotOf[static_cast<std::size_t>(node)]]);
  };
  if (linear) {
    for (std::size_t a = 0; a < 4; ++a) add(rest.tets[number][a], slopes[a]);
    return carried.norm();
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t point = 0; point < kQuadraticPoints; ++point) {
    mean += Eigen::Vector3d::Map(&quadratic->points[3 * point]) / static_cast<double>(kQuadraticPoints);
  }
  const std::array<double, kQuadraticNodes> all = quadraticSlopes(slopes, mean);
  for (std::size_t n = 0; n < kQuadraticNodes; ++n) add(quadratic->nodes[n], all[n]);
  return carried.norm();
}

}  // namespace tetskin::elastic_detail
