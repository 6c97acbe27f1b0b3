// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

namespace tetskin::cage_detail {

/// The search aims at a count within this fraction of the target.
constexpr double kCountTolerance = 0.10;

/// One lattice and the tets kept from it.
struct LatticeCage {
  LatticeFrame frame;
  LatticeSet set;               ///< touching the surface, inside it, or joining pinched parts
  std::size_t joiningTets = 0;  ///< number of these that only join pinched parts
  std::size_t lattices = 0;     ///< number of lattices tried to find this one
};

/// Finds the spacing, and the lattice's origin along each axis, for which about `target` tets are kept.
/// The count is not a continuous function of the spacing: on flat faces it jumps by whole layers. So the spacing is
/// bracketed at one origin first, then at others, until the count is good; in any case the best is returned.
/// firstOrigin  index of the first origin in the sequence: another one gives another lattice
/// Cost: lattices * O(triangles + target). Spacings never fall below `smallestSpacing`, even if that means fewer tets.
LatticeCage searchLattice(const Surface& surface, const WindingTree& winding, std::size_t target,
                          std::size_t firstOrigin);

/// Smallest half cube, rest space, whose tets double can represent without visible distortion at the surface's
/// coordinates, and whose cubes can be counted in 32 bits over its box.
double smallestSpacing(const Surface& surface);

}  // namespace tetskin::cage_detail
