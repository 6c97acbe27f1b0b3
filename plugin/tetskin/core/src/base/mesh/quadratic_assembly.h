// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <algorithm>
#include <array>
#include <optional>

namespace tetskin {

/// The edges of a tet, in the order of the midpoints of a QuadraticTet. Edges k and 5 - k have no corner in common.
constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// The barycentric weights of one of a quadratic tet's nodes; empty for any other node.
inline std::optional<std::array<double, 4>> weightsOf(const QuadraticTet& tet, int node) {
  const auto place = static_cast<std::size_t>(std::find(tet.nodes.begin(), tet.nodes.end(), node) - tet.nodes.begin());
  if (place == kQuadraticNodes) return {};
  std::array<double, 4> weights{};
  if (place < 4) weights[place] = 1.0;
  for (std::size_t k = 0; k < 2 && place >= 4; ++k) weights[kTetEdges[place - 4][k]] = 0.5;
  return weights;
}

/// How far a node may be from the middle of its edge, as a share of the edge. The resulting error is of the same size.
constexpr double kMidpointTolerance = 1e-4;

/// True if a node is at the middle of the edge between two others.
TETSKIN_CORE_API bool isMidpoint(const TetMesh& mesh, int node, int a, int b);

/// The quadratic tet whose uniform refinement these eight are, or empty: they may be in any order and orientation,
/// around any of the three diagonals. Cost O(1).
/// tets  ascending, indices in range
TETSKIN_CORE_API std::optional<QuadraticTet> assembleQuadraticTet(const TetMesh& mesh,
                                                                  const std::array<int, kSubTets>& tets);

}  // namespace tetskin
