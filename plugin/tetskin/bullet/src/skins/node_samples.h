// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftBodySkin: chooses the four nodes that reveal whether an application has moved a sleeping body as a
// whole by writing its nodes, for bodies whose own moves are counted.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>

namespace tetskin::bullet_detail {

using FourNodes = std::array<int, 4>;

/// The first four nodes from `start` on that are not in one plane; the last is -1 if there are none.
template <class At>
FourNodes independentFrom(std::size_t start, std::size_t count, At&& at) {
  assert(start < count);
  // A component orthogonal to the others counts as 0 below this fraction of the largest offset.
  constexpr double kIndependent = 1e-3;
  FourNodes found = {static_cast<int>(start), -1, -1, -1};
  const Eigen::Vector3d origin = at(start);
  Eigen::Vector3d axes[3];
  double largest = 0.0;
  std::size_t axisCount = 0;
  for (std::size_t n = start + 1; n < count && axisCount < 3; ++n) {
    Eigen::Vector3d offset = at(n) - origin;
    largest = std::max(largest, offset.norm());
    for (std::size_t k = 0; k < axisCount; ++k) offset -= axes[k].dot(offset) * axes[k];
    if (!(offset.norm() > kIndependent * largest)) continue;
    axes[axisCount++] = offset.normalized();
    found[axisCount] = static_cast<int>(n);
  }
  return found;
}

/// Four nodes that are not in one plane, close together in memory: each page that is not cached costs a sleeping body
/// one or two tenths of a microsecond. For a flat body, any four.
/// strideBytes  from one node to the next
/// at           position of a node
/// Cost         at most 64 passes over all nodes; for a lattice, over 64 of its layers
template <class At>
FourNodes nodesToSample(std::size_t count, std::size_t strideBytes, At&& at) {
  assert(count > 0 && strideBytes > 0);
  // Bytes of a page on most systems; and the number of starts that are tried, see Cost.
  constexpr std::size_t kPage = 4096, kStarts = 64;
  const auto page = [&](int n) { return static_cast<std::size_t>(n) * strideBytes / kPage; };
  const auto cost = [&](const FourNodes& n) { return std::make_pair(page(n[3]) - page(n[0]), n[3] - n[0]); };
  const int last = static_cast<int>(count) - 1;
  FourNodes best = {0, last / 3, 2 * last / 3, last};
  bool any = false;
  for (std::size_t start = 0; start + 3 < count; start += 1 + count / kStarts) {
    const FourNodes four = independentFrom(start, count, at);
    if (four[3] < 0) continue;
    if (!any || cost(four) < cost(best)) best = four;
    any = true;
  }
  return best;
}

}  // namespace tetskin::bullet_detail
