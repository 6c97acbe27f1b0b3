// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin::io {

/// Concave polygons with more corners are fanned instead of cut properly, which takes cubic time at worst.
constexpr std::size_t kMaxConcaveCorners = 256;

/// Appends the corners.size() - 2 triangles of a polygon. A convex one is fanned from its first corner; a concave one
/// is cut by clipping ears, in the plane of its area vector. For one that crosses itself, the triangles are
/// unspecified.
/// corners  3 or more indices of positions
void appendPolygon(const std::vector<Eigen::Vector3d>& positions, const std::vector<int>& corners,
                   std::vector<std::array<int, 3>>& triangles);

}  // namespace tetskin::io
