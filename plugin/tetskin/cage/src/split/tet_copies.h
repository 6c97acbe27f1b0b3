// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which parts of a body meet in a tet of the lattice: each gets a copy of the tet (a "virtual node" method).
//
// This work is based on:
//   Neil Molino, Zhaosheng Bao, Ron Fedkiw, "A Virtual Node Algorithm for Changing Mesh Topology During Simulation",
//   SIGGRAPH 2004 (a copy of an element for each piece of material in it)
#pragma once

#include <tetskin/cage/src/material/tet_material.h>
#include <tetskin/cage/src/split/lattice_links.h>
#include <tetskin/cage/src/surface/surface_samples.h>

#include <array>
#include <vector>

namespace tetskin::cage_detail {

struct TetCopies {
  struct Copy {
    int tet = -1;        ///< of the lattice mesh
    CellMask cells = 0;  ///< the material that is its own; none in one that only carries points
  };
  std::vector<Copy> copies;               ///< ascending by tet
  std::vector<int> copyOf;                ///< by point: a copy of the tet that holds it; -1 if none does
  std::vector<std::array<int, 2>> links;  ///< pairs of copies of tets that share a face, that hang together there
};

/// Pieces of material in a tet are one where cells share faces, or the surface joins them within the tet. A point
/// belongs to the piece just under it, in the tet that holds it. What is too thin for cells hangs together by the
/// surface alone, and by the way through it to its other side.
/// tetOf  by point: the tet that holds it, or -1
/// Cost   O(points + tets at the surface)
TetCopies copyTets(const Surface& surface, const SurfaceSamples& samples, const std::vector<int>& tetOf,
                   const TetMaterial& material, const LatticeFrame& frame, const LatticeSet& set,
                   const LatticeMesh& lattice, const LatticeLinks& links);

}  // namespace tetskin::cage_detail
