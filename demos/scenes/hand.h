// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A built-in model with slender components side by side: fingers that are nearer to each other than a tet of most cages
// is large.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// With fewer triangles the fingers could not be separated; with more, the lattice gets large.
constexpr std::size_t kMinHandTriangles = 4000, kMaxHandTriangles = 500000;

/// A hand that leans over to +z, some 1.2 wide, with five tapering fingers on its palm. At their roots these are 0.2
/// thick and 0.05 apart. Closed and welded, one component; within 5 % of `triangles`, which is clamped.
TriangleMesh makeHand(std::size_t triangles = 60000);

/// The fewest tets that makeHandTets makes.
constexpr std::size_t kMinHandTets = 12000;

/// The same body as a conforming mesh of tets, within 5 % of `tets`: a reference that no cage builder has made, and in
/// which the fingers share nothing but the palm.
TetMesh makeHandTets(std::size_t tets);

/// A plane across the fingers. Beyond it there is nothing but the five fingers.
Eigen::Hyperplane<double, 3> handPlane();

/// Negative inside the hand, positive outside; near the surface it is the distance from it.
double handDistance(const Eigen::Vector3d& p);

}  // namespace tetskin::scenes
