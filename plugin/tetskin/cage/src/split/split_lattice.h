// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/tet_copies.h>

#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// A cage on the lattice, whose tets may be copies of each other, with the points that it holds.
struct CageTets {
  TetMesh mesh;
  std::vector<std::uint8_t>
      openFaces;                 ///< by tet: bit c is set if no other tet lies beyond the face opposite to corner c
  std::vector<int> latticeTets;  ///< by tet: of the lattice mesh it was made of; copies share it
  std::vector<CellMask> cells;   ///< by tet: its own material
  std::vector<int> tetOf;        ///< by point: the tet that holds it, or -1
  bool split = false;            ///< some node is not the only one at its place in the lattice

  /// Tets beyond the first of those that share a lattice tet.
  std::size_t copies() const;
};

/// The lattice as it is: every tet once.
CageTets wholeLattice(const LatticeMesh& lattice, const TetMaterial& material, const std::vector<int>& tetOf);

/// The copies, joined face to face where they hang together: by nodes that they share. What the surface joins is one
/// part in any case; parts without a point are left out, and so are copies that hold next to nothing.
CageTets splitLattice(const TetCopies& copies, const SurfaceSamples& samples, const LatticeMesh& lattice,
                      const LatticeLinks& links);

}  // namespace tetskin::cage_detail
