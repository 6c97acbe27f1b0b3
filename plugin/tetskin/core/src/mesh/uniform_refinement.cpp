// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/mesh/uniform_refinement.h>

#include <algorithm>
#include <map>

namespace tetskin {
namespace {

/// The three diagonals of the octahedron between the midpoints of a tet's edges, each as two edges by their ends; and
/// the ring of four midpoints around it, each a step along an edge of the octahedron from the one before.
struct Diagonal {
  int ends[2][2];
  int ring[4][2];
};
constexpr Diagonal kDiagonals[3] = {
    {{{0, 1}, {2, 3}}, {{0, 2}, {1, 2}, {1, 3}, {0, 3}}},
    {{{0, 2}, {1, 3}}, {{0, 3}, {2, 3}, {1, 2}, {0, 1}}},
    {{{0, 3}, {1, 2}}, {{0, 1}, {1, 3}, {2, 3}, {0, 2}}},
};

/// The midpoints of a tet's edges, by the ends.
using Midpoints = std::array<std::array<int, 4>, 4>;

void appendCorners(const Tet& tet, const Midpoints& middle, std::vector<Tet>& tets) {
  for (int k = 0; k < 4; ++k) {
    Tet corner{};
    for (int j = 0; j < 4; ++j) corner[j] = j == k ? tet[k] : middle[k][j];
    tets.push_back(corner);
  }
}

void appendOctahedron(const std::vector<Eigen::Vector3d>& nodes, const Midpoints& middle, std::vector<Tet>& tets) {
  const auto at = [&](const int(&ends)[2]) { return middle[ends[0]][ends[1]]; };
  const auto length = [&](const Diagonal& d) { return (nodes[at(d.ends[0])] - nodes[at(d.ends[1])]).squaredNorm(); };
  const Diagonal& shortest = *std::min_element(std::begin(kDiagonals), std::end(kDiagonals),
                                               [&](const auto& a, const auto& b) { return length(a) < length(b); });
  for (int k = 0; k < 4; ++k) {
    tets.push_back({at(shortest.ends[0]), at(shortest.ring[(k + 1) % 4]), at(shortest.ring[k]), at(shortest.ends[1])});
  }
}

}  // namespace

Refinement refineUniformly(const TetMesh& coarse) {
  Refinement result;
  result.edges = uniqueEdges(coarse);
  result.mesh.nodes = coarse.nodes;
  std::map<std::array<int, 2>, int> middleOf;
  for (const auto& [a, b] : result.edges) {
    middleOf[{std::min(a, b), std::max(a, b)}] = static_cast<int>(result.mesh.nodeCount());
    result.mesh.nodes.emplace_back(0.5 * (coarse.nodes[a] + coarse.nodes[b]));
  }
  result.mesh.tets.reserve(8 * coarse.tetCount());
  for (const Tet& tet : coarse.tets) {
    Midpoints middle{};
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        middle[a][b] = middle[b][a] = middleOf.at({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
      }
    }
    appendCorners(tet, middle, result.mesh.tets);
    appendOctahedron(result.mesh.nodes, middle, result.mesh.tets);
  }
  return result;
}

}  // namespace tetskin
