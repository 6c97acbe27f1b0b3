// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

namespace tetskin::test {

/// Whether every edge is in two triangles that run along it in opposite directions; by the triangles' indices, without
/// welding.
bool isClosedAndOriented(const TriangleMesh& mesh);

/// The volume that a closed surface encloses: above 0 if its triangles face outwards.
double enclosedVolume(const TriangleMesh& mesh);

/// The least ratio of a triangle's height to its longest edge: 0.87 if all triangles are equilateral.
double flattestTriangle(const TriangleMesh& mesh);

}  // namespace tetskin::test
