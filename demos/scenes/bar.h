// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// A bar to twist: 4 units along x, about 1 wide, centred at the origin; its cross-section is a rounded square. Ridges
/// along it (if there are enough triangles for them) show where a surface is not smooth. One closed tube with a texture
/// seam, normals and texcoords; within 2 % of `triangles`, which is clamped as for the serpent.
TriangleMesh makeBar(std::size_t triangles = 60000);

}  // namespace tetskin::scenes
