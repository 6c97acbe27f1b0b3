// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin::io {

/// Corners above which a concave polygon is fanned instead of cut properly, which takes cubic time at worst.
constexpr std::size_t kMaxConcaveCorners = 256;

/// Appends the corners.size() - 2 triangles of a polygon. A convex one is fanned from its first corner; for a concave
/// one ears are clipped, in the plane of its area vector. For one that crosses itself, the triangles are not specified.
/// corners  3 or more indices of positions
void appendPolygon(const std::vector<Eigen::Vector3d>& positions, const std::vector<int>& corners,
                   std::vector<std::array<int, 3>>& triangles);

}  // namespace tetskin::io
