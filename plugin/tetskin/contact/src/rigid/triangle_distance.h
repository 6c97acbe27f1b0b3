// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: the point of a triangle that is closest to another point.
//
// This work is based on:
//   Christer Ericson, "Real-Time Collision Detection", 2005, section 5.1.5
#pragma once

#include <LinearMath/btVector3.h>

#include <array>

namespace tetskin {

using TriangleCorners = std::array<btVector3, 3>;

/// Also of triangles without area. Cost O(1)
btVector3 closestOnTriangle(const TriangleCorners& corners, const btVector3& point);

}  // namespace tetskin
