// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is drawn beside the serpent: a hat, a ring, a pointer. Meshes about the origin, y upwards.
#pragma once

#include <tetskin/core/triangle_mesh.h>

namespace tetskin::scenes {

/// A brim and a crown, its foot at the origin.
TriangleMesh makeHat(double radius);
/// In the plane of x and y.
TriangleMesh makeRing(double radius, double thickness);
/// A double cone, for a pointer.
TriangleMesh makePointer(double radius);

}  // namespace tetskin::scenes
