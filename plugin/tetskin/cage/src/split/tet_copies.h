// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which parts of a body meet in a tet of the lattice: each gets a copy of the tet (a "virtual node" method).
//
// This work is based on:
//   Neil Molino, Zhaosheng Bao, Ron Fedkiw, "A Virtual Node Algorithm for Changing Mesh Topology During Simulation",
//   SIGGRAPH 2004 (a copy of an element for each piece of material in it)
#pragma once

#include <tetskin/cage/src/split/tet_pieces.h>
#include <tetskin/cage/src/surface/surface_samples.h>

#include <array>
#include <vector>

namespace tetskin::cage_detail {

/// Each piece has a copy of its tet.
struct TetCopies {
  std::vector<TetPiece> copies;
  std::vector<int> copyOf;                ///< by point: a copy of the tet that holds it; -1 if none does
  std::vector<std::array<int, 2>> links;  ///< pairs of copies of tets that share a face, that hang together there
};

/// What hangs together within a tet (see `piecesIn`) is a copy, so that a point's copy is one of the tet that holds it,
/// whatever the shape. From tet to tet, copies hang together where cells share faces, or a triangle passes through.
///
/// tetOf  by point: the tet that holds it, or -1
TetCopies copyTets(const Surface& surface, const WindingTree& winding, const SurfaceSamples& samples,
                   const std::vector<int>& tetOf, const TetMaterial& material, const LatticeFrame& frame,
                   const LatticeMesh& lattice, const LatticeLinks& links);

}  // namespace tetskin::cage_detail
