// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Clips edges and triangles to a tet, in barycentric weights.
#pragma once

#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <array>

namespace tetskin::cage_detail {

/// True if the segment between two points passes through the tet, or by it within the rounding of lattice coordinates.
bool passesThrough(const Eigen::Vector4d& from, const Eigen::Vector4d& to);

/// Mean of the corners of the part of a triangle within the tet, as weights; for a triangle that only touches the tet,
/// a nearby point.
Eigen::Vector4d centroidWithin(const std::array<Eigen::Vector4d, 3>& triangle);

}  // namespace tetskin::cage_detail
