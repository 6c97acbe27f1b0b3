// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <algorithm>
#include <cassert>
#include <map>

namespace tetskin {
namespace {

/// The three diagonals of the octahedron between the midpoints of a tet's edges, each as two edges by their ends; and
/// the ring of four midpoints around it, each a step along an edge of the octahedron from the one before.
struct Diagonal {
  int ends[2][2];
  int ring[4][2];
};
/// Of the octahedron that is left in the middle: by the edges at whose midpoints it ends, with the four edges around
/// it.
constexpr Diagonal kDiagonals[3] = {
    {{{0, 1}, {2, 3}}, {{0, 2}, {1, 2}, {1, 3}, {0, 3}}},
    {{{0, 2}, {1, 3}}, {{0, 3}, {2, 3}, {1, 2}, {0, 1}}},
    {{{0, 3}, {1, 2}}, {{0, 1}, {1, 3}, {2, 3}, {0, 2}}},
};

/// The eight tets of one whose edges have these midpoints: by what stands for its corners and for the midpoints.
/// length  squared, between two midpoints
template <class Node, class Length>
std::array<std::array<Node, 4>, 8> eightTets(const std::array<Node, 4>& tet,
                                             const std::array<std::array<Node, 4>, 4>& centroid, Length&& length) {
  const auto at = [&](const int(&ends)[2]) { return centroid[ends[0]][ends[1]]; };
  std::array<std::array<Node, 4>, 8> eight;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 4; ++j) eight[k][j] = j == k ? tet[k] : centroid[k][j];
  }
  const auto lengthOf = [&](const Diagonal& d) { return length(at(d.ends[0]), at(d.ends[1])); };
  const Diagonal& shortest = *std::min_element(std::begin(kDiagonals), std::end(kDiagonals),
                                               [&](const auto& a, const auto& b) { return lengthOf(a) < lengthOf(b); });
  for (int k = 0; k < 4; ++k) {
    eight[4 + k] = {at(shortest.ends[0]), at(shortest.ring[(k + 1) % 4]), at(shortest.ring[k]), at(shortest.ends[1])};
  }
  return eight;
}

}  // namespace

Refinement refineUniformly(const TetMesh& coarse) {
  Refinement result;
  result.edges = uniqueEdges(coarse);
  result.mesh.nodes = coarse.nodes;
  std::map<std::array<int, 2>, int> centroidOf;
  for (const auto& [a, b] : result.edges) {
    centroidOf[{std::min(a, b), std::max(a, b)}] = static_cast<int>(result.mesh.nodeCount());
    result.mesh.nodes.emplace_back(0.5 * (coarse.nodes[a] + coarse.nodes[b]));
  }
  result.mesh.tets.reserve(8 * coarse.tetCount());
  for (const Tet& tet : coarse.tets) {
    std::array<std::array<int, 4>, 4> centroid{};
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        centroid[a][b] = centroid[b][a] = centroidOf.at({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
      }
    }
    const auto eight = eightTets(
        tet, centroid, [&](int a, int b) { return (result.mesh.nodes[a] - result.mesh.nodes[b]).squaredNorm(); });
    result.mesh.tets.insert(result.mesh.tets.end(), eight.begin(), eight.end());
  }
  assert(result.mesh.tetCount() == 8 * coarse.tetCount());
  return result;
}

std::array<TetCorners, 8> refinedTet(const TetCorners& p) {
  std::array<std::array<Eigen::Vector3d, 4>, 4> centroid;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) centroid[a][b] = centroid[b][a] = 0.5 * (p[a] + p[b]);
  }
  return eightTets(p, centroid,
                   [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).squaredNorm(); });
}

}  // namespace tetskin
