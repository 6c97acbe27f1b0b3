// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/shared/mesh/tet_geometry.h>
#include <tetskin/core/tet_mesh.h>

#include <array>
#include <vector>

namespace tetskin {

/// A tet mesh with every tet cut into eight.
struct Refinement {
  /// The nodes of the coarse mesh first, then one in the middle of every edge; eight tets for each, in its place.
  TetMesh mesh;
  /// midpoints x 2: the ends of the edge that node `coarse nodeCount + i` halves
  std::vector<std::array<int, 2>> edges;
};

/// Halves every edge. A tet becomes one at each corner and four around the shortest diagonal of the octahedron between
/// them, which keeps repeated refinements of a tet from getting thinner. Orientations are kept. Cost O(T log T).
///
/// This work is based on:
///   Jürgen Bey, "Tetrahedral Grid Refinement", Computing 55, 1995
///
/// coarse  indices in range
TETSKIN_CORE_API Refinement refineUniformly(const TetMesh& coarse);

/// The same eight tets of one alone, in the same order.
TETSKIN_CORE_API std::array<TetCorners, 8> refinedTet(const TetCorners& corners);

}  // namespace tetskin
