// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Finds which of the tets that no triangle touches are inside.
//
// Two answers are combined, because each fails where the other is safe.
// - Flood fill from outside on the lattice itself (a finer grid would only find gaps narrower than a tet, which the
//   touched tets fill anyway). It does not depend on orientation, doubled faces or self-intersections, but leaks
//   through any hole wider than a tet, and takes a pocket of air that touched tets enclose (between a dragon's legs)
//   for the inside.
// - The generalised winding number. It closes holes smoothly and distinguishes pockets and cavities from the inside,
//   but needs consistent orientation.
// Therefore: the untouched tets form connected regions. A region that does not reach the outside gets one answer for
// all its tets, by a vote of winding numbers; if the surface is too inconsistently oriented for these, the region is
// inside. The region that reaches the outside is outside if the surface has no open edges or is inconsistently
// oriented; otherwise each of its tets near the surface is tested, and the inside ones grow until they reach tets that
// are not.
//
// Consequences: overlapping components are filled where they overlap; a cavity (a smaller closed surface, turned
// inwards, within another) stays empty where it is wider than the tets around it, while a smaller closed surface turned
// outwards is filled; a bent open sheet is filled where it encloses more than half of the view.
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

namespace tetskin::cage_detail {

/// Adds the inside tets to the touched ones. Memory and time are proportional to the result and the tets around it,
/// never to the box.
/// limit   the fill stops if there are more tets than this, and returns false
bool fillInside(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame, std::size_t limit,
                LatticeSet& set);

}  // namespace tetskin::cage_detail
