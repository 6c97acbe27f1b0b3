// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Built-in models of thin and thick parts, without clefts.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// With fewer triangles the thin parts of the next two would be lost.
constexpr std::size_t kMinHoopTriangles = 2000;

/// A hoop that stands upright, 2 wide: a band of 0.5 with rounded edges, 0.36 thick at its foot and 0.12 at its top,
/// which gives way. Closed and welded, of one component with a hole; within 5 % of `triangles`, which is clamped as for
/// the hand, with the minimum above.
TriangleMesh makeHoop(std::size_t triangles = 60000);

/// A star of two tapering arms that are stretched upwards and apart, 2.2 from tip to tip, on a thick leg; all of them
/// grow from a ball. Otherwise as the hoop.
TriangleMesh makeStar(std::size_t triangles = 60000);

}  // namespace tetskin::scenes
