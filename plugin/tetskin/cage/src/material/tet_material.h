// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/material/tet_cells.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/shared/base/lists.h>
#include <tetskin/core/src/shared/mesh/winding_tree.h>

#include <vector>

namespace tetskin::cage_detail {

/// Where the body is in the tets of a lattice.
struct TetMaterial {
  std::vector<CellMask> cells;  ///< by tet: those whose centroid is inside the surface
  Lists<> triangles;            ///< by tet: the surface's triangles that touch it

  /// The winding number at the centroid of a cell that is material, rounded: above 1 where parts of the surface
  /// overlap.
  int windingOf(int tet, int cell) const { return windingsAt[tet] < 0 ? 1 : windings[windingsAt[tet]][cell]; }

  std::vector<int> windingsAt;  ///< by tet: where in `windings`; -1: 1 in all of it
  std::vector<std::array<std::int16_t, kCellsPerTet>> windings;
};

/// A cell is inside where the winding number is at least a half, either sign. It is asked for once a tet; from there to
/// each cell it changes by one with every triangle between, and only those that touch the tet can be. Tets that no
/// triangle touches are inside as a whole, but for those that only join others. All of it is material if the surface is
/// not oriented, as there is no telling then, and nothing of a sheet.
/// Cost: of triangles x tets that touch, 64 tests each, and a winding number a tet at the surface
TetMaterial findMaterial(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame,
                         const LatticeSet& set, const LatticeMesh& lattice);

}  // namespace tetskin::cage_detail
