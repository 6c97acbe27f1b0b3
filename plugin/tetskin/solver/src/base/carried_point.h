// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: a point carried by nodes of a soft body.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace tetskin::bullet_detail {

/// The corners of a triangle may be in three different tets.
constexpr std::size_t kMaxPointNodes = 12;

/// The weighted mean of some nodes.
struct CarriedPoint {
  std::uint32_t count = 0;                         ///< number of entries in use of the next two; 0: no such point
  std::array<int, kMaxPointNodes> nodes{};         ///< in the body
  std::array<btScalar, kMaxPointNodes> weights{};  ///< sum 1; some may be below 0

  CarriedPoint() = default;
  /// from, by  nodes and their weights, `nodeCount` of each
  template <class Nodes, class Weights>
  CarriedPoint(std::size_t nodeCount, const Nodes& from, const Weights& by)
      : count(static_cast<std::uint32_t>(nodeCount)) {
    assert(nodeCount <= kMaxPointNodes);
    for (std::size_t k = 0; k < nodeCount; ++k) {
      nodes[k] = from[k];
      weights[k] = by[k];
    }
  }

  void add(int node, btScalar weight) {
    assert(count < kMaxPointNodes);
    nodes[count] = node;
    weights[count++] = weight;
  }
  /// The weighted sum of the nodes' values.
  /// valueOf  (int node) -> btVector3
  template <class ValueOf>
  btVector3 sum(ValueOf&& valueOf) const {
    btVector3 sum(0, 0, 0);
    for (std::uint32_t k = 0; k < count; ++k) sum += weights[k] * valueOf(nodes[k]);
    return sum;
  }
  btVector3 velocity(const btSoftBody& body) const {
    return sum([&](int n) -> const btVector3& { return body.m_nodes[n].m_v; });
  }
  /// Sums offsets from the first node, so that little is lost in rounding far from the origin.
  btVector3 position(const btSoftBody& body) const {
    assert(count > 0);
    const btVector3 first = body.m_nodes[nodes[0]].m_x;
    return first + sum([&](int n) { return body.m_nodes[n].m_x - first; });
  }
  /// True if any of its nodes can move.
  bool isFree(const btSoftBody& body) const {
    return std::any_of(nodes.begin(), nodes.begin() + count, [&](int n) { return body.m_nodes[n].m_im > 0; });
  }
};

}  // namespace tetskin::bullet_detail
