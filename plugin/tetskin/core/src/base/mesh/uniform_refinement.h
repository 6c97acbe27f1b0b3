// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace tetskin {

/// A tet mesh with every tet cut into eight.
struct Refinement {
  /// The nodes of the coarse mesh first, then one at the middle of every edge; the eight tets of each coarse tet, in
  /// the order of the coarse tets.
  TetMesh mesh;
  /// midpoints x 2: the ends of the edge that node `coarse nodeCount + i` halves
  std::vector<std::array<int, 2>> edges;
};

/// Halves every edge. A tet becomes one tet at each corner, and four around the shortest diagonal of the octahedron
/// between them, so that repeated refinement does not make tets thinner. Orientations are kept. Cost O(T log T).
///
/// This work is based on:
///   Jürgen Bey, "Tetrahedral Grid Refinement", Computing 55, 1995
///
/// coarse  indices in range
TETSKIN_CORE_API Refinement refineUniformly(const TetMesh& coarse);

/// The three diagonals of the octahedron between the midpoints of a tet's edges: each as two edges, given by their
/// ends, and the ring of four midpoints around it, in which neighbours share an edge of the octahedron.
struct OctahedronDiagonal {
  int ends[2][2];
  int ring[4][2];
};
/// The diagonals of the octahedron in the middle: the edges at whose midpoints each ends, and the four edges around it.
inline constexpr OctahedronDiagonal kOctahedronDiagonals[3] = {
    {{{0, 1}, {2, 3}}, {{0, 2}, {1, 2}, {1, 3}, {0, 3}}},
    {{{0, 2}, {1, 3}}, {{0, 3}, {2, 3}, {1, 2}, {0, 1}}},
    {{{0, 3}, {1, 2}}, {{0, 1}, {1, 3}, {2, 3}, {0, 2}}},
};

/// The eight tets of a tet whose edges have these midpoints, in terms of what stands for its corners and midpoints.
/// length  squared, between two midpoints
template <class Node, class Length>
std::array<std::array<Node, 4>, 8> eightTets(const std::array<Node, 4>& tet,
                                             const std::array<std::array<Node, 4>, 4>& midpoint, Length&& length) {
  const auto at = [&](const int(&ends)[2]) { return midpoint[ends[0]][ends[1]]; };
  std::array<std::array<Node, 4>, 8> eight;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 4; ++j) eight[k][j] = j == k ? tet[k] : midpoint[k][j];
  }
  const auto lengthOf = [&](const OctahedronDiagonal& d) { return length(at(d.ends[0]), at(d.ends[1])); };
  const OctahedronDiagonal& shortest =
      *std::min_element(std::begin(kOctahedronDiagonals), std::end(kOctahedronDiagonals),
                        [&](const auto& a, const auto& b) { return lengthOf(a) < lengthOf(b); });
  for (int k = 0; k < 4; ++k) {
    eight[4 + k] = {at(shortest.ends[0]), at(shortest.ring[(k + 1) % 4]), at(shortest.ring[k]), at(shortest.ends[1])};
  }
  return eight;
}

/// The eight small tets of a single tet, in the same order.
/// midpoints  nodes at the middles of the edges 01, 02, 03, 12, 13, 23
/// nodes      positions, which determine the shortest diagonal
inline std::array<Tet, 8> refinedTet(const Tet& corners, const std::array<int, 6>& midpoints,
                                     const std::vector<Eigen::Vector3d>& nodes) {
  std::array<std::array<int, 4>, 4> midpoint{};
  std::size_t next = 0;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) midpoint[a][b] = midpoint[b][a] = midpoints[next++];
  }
  return eightTets(corners, midpoint, [&](int a, int b) { return (nodes[a] - nodes[b]).squaredNorm(); });
}
/// Overload for a tet without a mesh. Not compiled into the library, because Eigen has another namespace in some
/// libraries.
inline std::array<TetCorners, 8> refinedTet(const TetCorners& p) {
  std::array<std::array<Eigen::Vector3d, 4>, 4> midpoint;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) midpoint[a][b] = midpoint[b][a] = 0.5 * (p[a] + p[b]);
  }
  return eightTets(p, midpoint,
                   [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).squaredNorm(); });
}

}  // namespace tetskin
