// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/extra_damping.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::elastic_detail {

DampingParts dampingParts(double damping, const std::vector<double>& factors) {
  assert(damping >= 0.0);
  if (factors.empty()) return {damping, damping, {}};
  const auto [first, last] = std::minmax_element(factors.begin(), factors.end());
  DampingParts parts{*first * damping, *first * damping, {}};
  for (const double factor : factors) {
    if (damping * (*last - *first) > 0.0) parts.more.push_back(damping * (factor - *first));
  }
  if (parts.more.empty()) return parts;
  const double sum = std::accumulate(factors.begin(), factors.end(), 0.0);
  parts.mean = sum / static_cast<double>(factors.size()) * damping;
  return parts;
}

template <class S>
void ExtraDamping<S>::take(const RestTets& rest, const S* corners, S ratio, S spread, const std::vector<double>& shares,
                           ParallelFor* threads) {
  assert(shares.size() == rest.count() + rest.quadratic.size());
  corners_.assign(4 * rest.cornerCount(), S(0));
  const auto copy = [&](std::size_t tet, std::size_t first, std::size_t count) {
    const auto root = static_cast<S>(std::sqrt(shares[tet]));
    for (std::size_t k = 4 * first; k < 4 * (first + count); ++k) corners_[k] = root * corners[k];
  };
  for (std::size_t t = 0; t < rest.count(); ++t) copy(t, 4 * t, 4);
  for (std::size_t q = 0; q < rest.quadratic.size(); ++q) {
    copy(rest.count() + q, rest.quadraticCorner(q), RestTets::kCornersPerNode * kQuadraticNodes);
  }
  matrix_.assemble(corners_.data(), ratio, threads, spread);
}

template <class S>
void ExtraDamping<S>::takeFrom(AlignedVector<S>& impulses, const S* velocities, ParallelFor* threads) {
  assert(impulses.size() == matrix_.wideSize());
  points_.resize(4 * matrix_.slotCount(), S(0));
  products_.resize(impulses.size());
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) points_[4 * slot + k] = velocities[wide + k * kernels::kGroup];
  });
  matrix_.multiply(points_.data(), products_.data(), threads);
  for (std::size_t k = 0; k < impulses.size(); ++k) impulses[k] -= products_[k];
}

TETSKIN_INSTANTIATE_CLASS(ExtraDamping)

}  // namespace tetskin::elastic_detail
