// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/material/tet_cells.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <cassert>
#include <vector>

namespace tetskin::cage_detail {

/// Which cells of the tets of a lattice are material.
struct TetMaterial {
  std::vector<CellMask> cells;  ///< by tet: those whose centroid is inside the surface
  Lists<> triangles;            ///< by tet: the surface's triangles that touch it

  /// The winding number at the centroid of a material cell, rounded: above 1 where parts of the surface overlap.
  int windingOf(int tet, int cell) const {
    assert((cells[tet] >> cell & 1) != 0);
    return windingsAt[tet] < 0 ? 1 : windings[windingsAt[tet]][cell];
  }

  std::vector<int> windingsAt;  ///< by tet: index in `windings`; -1: 1 in all of its cells
  std::vector<std::array<std::int16_t, kCellsPerTet>> windings;
};

/// A cell is inside if the absolute winding number is at least a half. The winding number is computed once per tet;
/// from there to each cell it changes by one with every triangle in between, and only triangles that touch the tet can
/// be in between. Tets that no triangle touches are inside as a whole, except those that only join others. If the
/// surface is not oriented, everything counts as material, because inside and outside cannot be distinguished; a sheet
/// has no material.
/// Cost: 64 tests for each pair of a triangle and a touched tet, and one winding number per tet at the surface
TetMaterial findMaterial(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame,
                         const LatticeSet& set, const LatticeMesh& lattice);

}  // namespace tetskin::cage_detail
