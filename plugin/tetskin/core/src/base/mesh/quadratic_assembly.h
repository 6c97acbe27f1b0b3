// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <array>
#include <optional>

namespace tetskin {

/// The edges of a tet, in the order of the midpoints of a QuadraticTet. Edges k and 5 - k have no corner in common.
constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// How far a node may be from the middle of its edge, as a share of the edge. What is left out of account then is of
/// that size, too.
constexpr double kMidpointTolerance = 1e-4;

/// True if a node is at the middle of the edge between two others.
TETSKIN_CORE_API bool isMidpoint(const TetMesh& mesh, int node, int a, int b);

/// The quadratic tet that these eight are the uniform refinement of, if they are that: in any order and orientation,
/// around any of the three diagonals. Cost O(1).
/// tets  ascending, indices in range
TETSKIN_CORE_API std::optional<QuadraticTet> assembleQuadraticTet(const TetMesh& mesh,
                                                                  const std::array<int, kSubTets>& tets);

}  // namespace tetskin
