// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>

#include <array>
#include <vector>

namespace tetskin::cage_detail {

/// The adjacency of a lattice mesh, in terms of its tets' numbers.
struct LatticeLinks {
  LatticeLinks(const LatticeSet& set, const LatticeMesh& lattice);

  std::vector<LatticeTet> tets;            ///< by tet: its position in the lattice
  std::vector<std::array<int, 4>> beyond;  ///< by tet: the tets beyond the faces opposite to its corners, or -1

  /// The corner of `tet` opposite to the face that it shares with another, or -1.
  int cornerTowards(int tet, int other) const {
    for (int corner = 0; corner < 4; ++corner) {
      if (beyond[tet][corner] == other) return corner;
    }
    return -1;
  }
};

inline LatticeLinks::LatticeLinks(const LatticeSet& set, const LatticeMesh& lattice)
    : tets(lattice.mesh.tetCount()), beyond(lattice.mesh.tetCount()) {
  for (std::size_t cube = 0; cube < set.cubeCount(); ++cube) {
    for (int local = 0; local < kTetsPerCube; ++local) {
      const int t = lattice.tetOf[kTetsPerCube * cube + static_cast<std::size_t>(local)];
      if (t < 0) continue;
      tets[t] = {set.cube(cube), local};
      for (int corner = 0; corner < 4; ++corner) {
        beyond[t][corner] = lattice.indexOf(set, set.cube(cube) + latticeTables().neighbours[local][corner]);
      }
    }
  }
}

}  // namespace tetskin::cage_detail
