// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The built-in model: a coiled, scaly serpent with any number of triangles. Nothing is loaded, nothing is random: equal
// options give the same bits.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// Fewest and most triangles that `makeSerpent` makes; a request beyond these is clamped.
constexpr std::size_t kMinSerpentTriangles = 2000, kMaxSerpentTriangles = 2000000;

struct SerpentOptions {
  std::size_t triangles = 60000;  ///< requested; the mesh has this number within 2 %
};

/// The serpent at rest: about 1.8 x 1.1 x 2 units, y up, standing on y = 0, centred at the origin in x and z, looking
/// towards +z. "body" and "head" are one closed tube; the groups before them are closed components sunk into it. Every
/// component has a texture seam: vertices at bit-identical positions with u = 0 and u = 1. Normals and texcoords are
/// filled.
TriangleMesh makeSerpent(const SerpentOptions& options = {});

}  // namespace tetskin::scenes
