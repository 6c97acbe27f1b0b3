// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/body_ways.h>
#include <tetskin/core/src/shared/mesh/winding_tree.h>

#include <vector>

namespace tetskin::cage_detail {

/// Of a body in a tet, what hangs together there.
struct TetPiece {
  int tet = -1;        ///< of the lattice mesh
  CellMask cells = 0;  ///< the material that is its own; none where only surface passes through
};

struct TetPieces {
  std::vector<TetPiece> pieces;  ///< ascending by tet
  std::vector<int> starts;       ///< tets + 1: the first piece of each
  std::vector<int> pieceOf;      ///< by element, see BodyWays
  std::vector<char> layered;     ///< by tet: the surface passes through it more than once
};

/// Within a tet, what of a triangle is in it hangs together, and with what is of the next triangle where an edge that
/// they share passes through the tet. Cells of material do by faces that no surface lies in, or if a straight way
/// between them stays inside. Surface does with the material under it, or, where it is too thin for cells, with the
/// surface on its other side. Components that lie in each other, or nearer to each other than an eighth of a tet, are
/// one where they do.
///
/// tetOf  by point of the surface, and any more: the tet that holds it, or -1
/// Cost   O(pairs of triangle and touched tet), a few microseconds each
TetPieces piecesIn(const Surface& surface, const WindingTree& winding, const std::vector<int>& tetOf,
                   const TetMaterial& material, const LatticeFrame& frame, const LatticeMesh& lattice,
                   const LatticeLinks& links, const BodyWays& ways);

}  // namespace tetskin::cage_detail
