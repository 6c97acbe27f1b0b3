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
    CellMask cells = 0;  ///< the material that is its own; none in one that only surface passes through
  };
  std::vector<Copy> copies;               ///< ascending by tet
  std::vector<int> copyOf;                ///< by point: a copy of the tet that holds it; -1 if none does
  std::vector<std::array<int, 2>> links;  ///< pairs of copies of tets that share a face, that hang together there
};

/// Within each tet, what of a triangle is in it hangs together, and with what is of the next triangle where an edge
/// that they share passes through the tet; cells of material do by faces, or if a straight way between them stays
/// inside; and surface does with the material under it, or, where it is too thin for cells, with the surface on its
/// other side. What hangs together is a copy. So a point's copy is one of the tet that holds it, whatever the shape.
/// From tet to tet, copies hang together where cells share faces, or a triangle passes through. tetOf  by point: the
/// tet that holds it, or -1 Cost   O(pairs of triangle and touched tet), a few microseconds each
TetCopies copyTets(const Surface& surface, const WindingTree& winding, const SurfaceSamples& samples,
                   const std::vector<int>& tetOf, const TetMaterial& material, const LatticeFrame& frame,
                   const LatticeMesh& lattice, const LatticeLinks& links);

}  // namespace tetskin::cage_detail
