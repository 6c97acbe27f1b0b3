// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/segment_queries.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <vector>

namespace tetskin::cage_detail {

/// A connected piece of a body within a tet.
struct TetPiece {
  int tet = -1;        ///< of the lattice mesh
  CellMask cells = 0;  ///< its own material; 0 if only surface passes through
};

struct TetPieces {
  std::vector<TetPiece> pieces;  ///< ascending by tet
  std::vector<int> starts;       ///< tets + 1 entries: the first piece of each
  std::vector<int> pieceOf;      ///< by element, see SegmentQueries
  std::vector<char> layered;     ///< by tet: the surface passes through it more than once
};

/// Within a tet, the part of a triangle in it is connected, also with the part of the next triangle if a common edge
/// passes through the tet. Cells of material are connected by faces that contain no surface, or if a straight segment
/// between them stays inside. Surface is connected with the material below it or, where it is too thin for cells, with
/// the surface on its other side. Components that lie inside each other, or nearer to each other than an eighth of a
/// tet, are united there.
///
/// tetOf  by point, the surface's own and further ones: the tet that contains it, or -1
/// Cost   O(pairs of triangle and touched tet), a few microseconds each
TetPieces piecesIn(const Surface& surface, const WindingTree& winding, const std::vector<int>& tetOf,
                   const TetMaterial& material, const LatticeFrame& frame, const LatticeMesh& lattice,
                   const LatticeLinks& links, const SegmentQueries& directions);

}  // namespace tetskin::cage_detail
