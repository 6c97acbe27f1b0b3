// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ContactShape: the normals that decide which surfaces can touch.
#pragma once

#include <tetskin/contact/src/soft/distance_grid.h>
#include <tetskin/contact/src/soft/surface_samples.h>

namespace tetskin::contact_detail {

/// By sample: the gradient of the grid, which points outwards and is shorter than 1 on edges. It is 0 where the grid
/// has none, and on tips that are finer than its cubes: there it may point anywhere, even inwards, and the sample may
/// touch from any side.
/// triangles  those that have been sampled
/// Cost       O(n) for n triangles and samples
std::vector<btVector3> sampleNormals(const TriangleMesh& mesh, const std::vector<int>& triangles,
                                     const std::vector<SurfaceSample>& samples, const DistanceGrid& grid);

}  // namespace tetskin::contact_detail
