// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Duplicate elements with virtual nodes: each connected part of a body in a tet of the lattice gets its own duplicate.
//
// This work is based on:
//   Neil Molino, Zhaosheng Bao, Ron Fedkiw, "A Virtual Node Algorithm for Changing Mesh Topology During Simulation",
//   SIGGRAPH 2004 (a duplicate of an element for each piece of material in it)
#pragma once

#include <tetskin/cage/src/split/tet_pieces.h>
#include <tetskin/cage/src/surface/surface_samples.h>

#include <array>
#include <vector>

namespace tetskin::cage_detail {

/// One duplicate of a tet for each piece.
struct TetCopies {
  std::vector<TetPiece> copies;
  std::vector<int> copyOf;                ///< by point: a duplicate of the tet that contains it; -1 if none does
  std::vector<std::array<int, 2>> links;  ///< pairs of duplicates, of tets that share a face, that are connected there
};

/// Each connected piece within a tet (see `piecesIn`) becomes a duplicate, so a point's duplicate always belongs to the
/// tet that contains it, whatever the shape. Between tets, duplicates are connected where cells share faces, or where a
/// triangle passes through.
///
/// tetOf  by point: the tet that contains it, or -1
TetCopies copyTets(const Surface& surface, const WindingTree& winding, const SurfaceSamples& samples,
                   const std::vector<int>& tetOf, const TetMaterial& material, const LatticeFrame& frame,
                   const LatticeMesh& lattice, const LatticeLinks& links);

}  // namespace tetskin::cage_detail
