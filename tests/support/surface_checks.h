// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/triangle_mesh.h>

namespace tetskin::test {

/// Every edge is in two triangles, which run along it in opposite directions; by the triangles' indices, without
/// welding.
bool isClosedAndOriented(const TriangleMesh& mesh);

/// Of a closed surface: above 0 if its triangles look outwards.
double enclosedVolume(const TriangleMesh& mesh);

/// Least height of a triangle over its longest edge: 0.87 if all have equal sides.
double flattestTriangle(const TriangleMesh& mesh);

}  // namespace tetskin::test
