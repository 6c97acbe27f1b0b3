// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A built-in model of slender parts side by side: fingers, nearer to each other than a tet of most cages.
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// With fewer triangles the fingers would not be told apart; with more, the lattice gets large.
constexpr std::size_t kMinHandTriangles = 4000, kMaxHandTriangles = 500000;

/// A hand that leans over to +z, some 1.2 wide, on its palm five tapering fingers, 0.2 thick at their roots and there
/// 0.05 apart. Closed and welded, one part; within 5 % of `triangles`, which are clamped.
TriangleMesh makeHand(std::size_t triangles = 60000);

/// Fewest tets of the mesh below.
constexpr std::size_t kMinHandTets = 12000;

/// The same body as a conforming mesh of tets, within 5 % of `tets`: a reference that no builder of cages has made, and
/// in which the fingers share nothing but the palm.
TetMesh makeHandTets(std::size_t tets);

/// Across the fingers. Beyond it there is nothing but the five.
Eigen::Hyperplane<double, 3> handPlane();

/// Below 0 within the hand, above it outside; near the surface the distance from it.
double handDistance(const Eigen::Vector3d& p);

}  // namespace tetskin::scenes
