// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/lists.h>

namespace tetskin::cage_detail {

/// How near, in lattice coordinates, a triangle must come to touch a tet. Far above the rounding error of lattice
/// coordinates (2e-7 for the farthest cubes), so that no touching tet is missed, and enough to keep vertices inside
/// when they or the cage are rounded to single precision; far below anything visible in the count.
constexpr double kTouch = 2e-5;

/// Adds to an empty set all tets that a triangle of the surface touches. Each triangle is followed from a corner's tet
/// to neighbours as long as they are touched, too; so the cost is proportional to the number of pairs of triangle and
/// touched tet, whatever the triangles' size.
/// limit   the cover stops if there are more tets than this, and returns false
bool coverSurface(const Surface& surface, const LatticeFrame& frame, std::size_t limit, LatticeSet& set);

/// By tet of a lattice mesh made from such a set: the triangles that touch it, ascending. Tets that are not in the mesh
/// are skipped.
Lists<> trianglesByTet(const Surface& surface, const LatticeFrame& frame, const LatticeSet& set,
                       const LatticeMesh& lattice);

}  // namespace tetskin::cage_detail
