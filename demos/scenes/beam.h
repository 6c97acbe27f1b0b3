// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A built-in model that its tets fill exactly, of which beam theory knows how it bends.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// A beam of 4 x 1 x 1 units along x, centred at the origin. Closed and welded; at least `triangles`, and only a few
/// more. `triangles` is clamped as for the serpent.
TriangleMesh makeBeam(std::size_t triangles = 60000);

/// The fewest tets that makeBeamTets makes.
constexpr std::size_t kMinBeamTets = 20;

/// The same body as a conforming mesh of 20 n^3 tets, five to each cube of a grid, with the n that is nearest.
TetMesh makeBeamTets(std::size_t tets);

}  // namespace tetskin::scenes
