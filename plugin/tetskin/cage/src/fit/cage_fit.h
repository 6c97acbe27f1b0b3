// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/split_lattice.h>

#include <vector>

namespace tetskin::cage_detail {

/// Pulls the boundary nodes of a cage towards the surface, and moves the inner nodes out of their way.
/// cage      nodes are moved; tets stay as they are; which of them holds a point is kept up to date
/// half      spacing of the lattice the cage came from, rest space
/// points    what the cage has to hold, and must go on holding in the sense of `embed`
/// Every dihedral angle stays within kMinDihedralDeg and kMaxDihedralDeg. Each move is checked by itself and taken back
/// if it would break one of these; so the cage is valid at any time. Cost O(tets + points), a few dozen visits each.
void fitCage(CageTets& cage, double half, const std::vector<Eigen::Vector3d>& points);

}  // namespace tetskin::cage_detail
