// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/skinning/edge_bends.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
QuadraticEdges::QuadraticEdges(const TetMesh& mesh, const std::vector<QuadraticTet>& tets) : tets_(tets) {
  for (std::size_t k = 0; k < tets.size(); ++k) {
    for (const int t : tets[k].tets) {
      for (const auto& [i, j] : kTetEdges) {
        const auto a = static_cast<std::uint32_t>(mesh.tets[t][i]), b = static_cast<std::uint32_t>(mesh.tets[t][j]);
        entries_.push_back({{std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(k)});
      }
    }
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.edge < b.edge; });
  entries_.erase(
      std::unique(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.edge == b.edge; }),
      entries_.end());
}

std::vector<QuadraticEdges::Entry>::const_iterator QuadraticEdges::find(const CageEdge& edge) const {
  return std::lower_bound(entries_.begin(), entries_.end(), edge,
                          [](const Entry& entry, const CageEdge& wanted) { return entry.edge < wanted; });
}

bool QuadraticEdges::contains(const CageEdge& edge) const {
  const auto found = find(edge);
  return found != entries_.end() && found->edge == edge;
}

/// Along d, the difference of the weights of its ends, the map's second derivative is the sum of 4 d_i d_i x_i and of
/// 8 d_i d_j x_ij, with x_i the corners and x_ij the midpoints. An edge's vector is -1/2 of it.
EdgeBend QuadraticEdges::bendOf(const CageEdge& edge) const {
  assert(contains(edge));
  const QuadraticTet& tet = tets_[find(edge)->tet];
  std::array<double, 4> d = *weightsOf(tet, static_cast<int>(edge[1]));
  const std::array<double, 4> first = *weightsOf(tet, static_cast<int>(edge[0]));
  for (std::size_t k = 0; k < 4; ++k) d[k] -= first[k];
  EdgeBend bend;
  const auto add = [&](std::size_t node, double factor) {
    if (factor == 0.0) return;
    bend.nodes.push_back(static_cast<std::uint32_t>(tet.nodes[node]));
    bend.factors.push_back(factor);
  };
  for (std::size_t k = 0; k < 4; ++k) add(k, -2.0 * d[k] * d[k]);
  for (std::size_t e = 0; e < kTetEdges.size(); ++e) add(4 + e, -4.0 * d[kTetEdges[e][0]] * d[kTetEdges[e][1]]);
  return bend;
}

}  // namespace tetskin
