// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// A bar to twist: 4 units along x, about 1 wide, centred at the origin, its section a rounded square. Ridges along it
/// (if there are triangles enough for them) show where a surface is not smooth. One closed tube with a texture seam,
/// normals and texcoords; within 2 % of `triangles`, which are clamped as those of the serpent.
TriangleMesh makeBar(std::size_t triangles = 60000);

}  // namespace tetskin::scenes
