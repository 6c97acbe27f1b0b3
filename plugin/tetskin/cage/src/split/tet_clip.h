// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What of edges and triangles is in a tet, by the barycentric weights of their corners.
#pragma once

#include <tetskin/core/src/shared/mesh/tet_geometry.h>

#include <array>

namespace tetskin::cage_detail {

/// True if the straight way between two points passes through the tet, or by it within the rounding of lattices.
bool passesThrough(const Eigen::Vector4d& from, const Eigen::Vector4d& to);

/// Middle of the corners of what of a triangle is in the tet, as weights; of one that only touches it, near by.
Eigen::Vector4d middleWithin(const std::array<Eigen::Vector4d, 3>& triangle);

}  // namespace tetskin::cage_detail
