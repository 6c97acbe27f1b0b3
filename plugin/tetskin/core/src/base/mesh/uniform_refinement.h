// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <array>
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

/// Halves every edge. A tet becomes one at each corner and four around the shortest diagonal of the octahedron between
/// them, which keeps repeated refinements of a tet from getting thinner. Orientations are kept. Cost O(T log T).
///
/// This work is based on:
///   Jürgen Bey, "Tetrahedral Grid Refinement", Computing 55, 1995
///
/// coarse  indices in range
TETSKIN_CORE_API Refinement refineUniformly(const TetMesh& coarse);

/// The eight small tets of a single tet, in the same order.
TETSKIN_CORE_API std::array<TetCorners, 8> refinedTet(const TetCorners& corners);

}  // namespace tetskin
