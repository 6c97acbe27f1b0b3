// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/tet_copies.h>

#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// A cage on the lattice, which may contain duplicate tets, with the points that it contains.
struct CageTets {
  TetMesh mesh;
  /// By tet: bit c is set if no other tet lies beyond the face opposite to corner c.
  std::vector<std::uint8_t> openFaces;
  std::vector<int> latticeTets;  ///< by tet: its tet in the lattice mesh; duplicates share it
  std::vector<CellMask> cells;   ///< by tet: its own material
  std::vector<int> tetOf;        ///< by point: the tet that contains it, or -1
  bool split = false;            ///< some node has a duplicate at the same lattice position

  /// The number of tets beyond the first of each lattice tet.
  std::size_t copies() const;
};

/// The lattice without duplicates: every tet once.
CageTets wholeLattice(const LatticeMesh& lattice, const TetMaterial& material, const std::vector<int>& tetOf);

/// The duplicates, joined face to face where they are connected: by sharing nodes. Each component of the surface ends
/// up in one component of the cage; components without a point are removed, as are duplicates that contain almost
/// nothing.
CageTets splitLattice(const TetCopies& copies, const SurfaceSamples& samples, const LatticeMesh& lattice,
                      const LatticeLinks& links);

}  // namespace tetskin::cage_detail
