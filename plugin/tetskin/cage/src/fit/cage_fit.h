// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/split_lattice.h>

#include <vector>

namespace tetskin::cage_detail {

/// Pulls the boundary nodes of a cage towards the surface, and moves the inner nodes out of their way.
/// cage      nodes are moved, tets stay; the tet that contains each point is updated
/// half      half the spacing of the cage's lattice, rest space
/// points    which the cage contains, and must still contain in the sense of `embed`
/// Every dihedral angle stays within kMinDihedralDeg and kMaxDihedralDeg. Each move is checked separately, and undone
/// if it would violate one of these conditions, so the cage is valid at any time. Cost O(tets + points), a few dozen
/// visits each.
void fitCage(CageTets& cage, double half, const std::vector<Eigen::Vector3d>& points);

}  // namespace tetskin::cage_detail
