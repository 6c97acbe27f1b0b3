// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which tet of the cage contains which point of the surface; updated as nodes move.
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <vector>

namespace tetskin::cage_detail {

/// The tet of every point, evaluated exactly as `embed` does: barycentric distance at most 0 in double. -1 if there is
/// none, which only happens to points within rounding error of a face of the lattice.
std::vector<int> bindPoints(const std::vector<Eigen::Vector3d>& points, const LatticeSet& set,
                            const LatticeFrame& frame, const LatticeMesh& lattice);

/// Number of the first `count` points that are not in their tet. Cost O(count).
std::size_t countOutside(const std::vector<Eigen::Vector3d>& points, std::size_t count, const TetMesh& mesh,
                         const std::vector<int>& tetOf);

}  // namespace tetskin::cage_detail
