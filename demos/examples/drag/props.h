// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Objects drawn beside the serpent: a hat, a ring, a pointer. Meshes about the origin, y up.
#pragma once

#include <tetskin/core/mesh.h>

namespace tetskin::scenes {

/// A hat with a brim and a crown, its lower side at the origin.
TriangleMesh makeHat(double radius);
/// A ring in the xy plane.
TriangleMesh makeRing(double radius, double thickness);
/// A double cone that stands for a pointer.
TriangleMesh makePointer(double radius);

}  // namespace tetskin::scenes
