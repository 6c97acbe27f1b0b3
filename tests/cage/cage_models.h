// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Triangle meshes, good and bad, for the tests of the cage builder.
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <cstddef>

namespace tetskin::test {

/// Unit sphere about the origin, see `sphere` in support.
TriangleMesh unitSphere(int rings);
/// The part of a unit sphere with polar angles up to `openingRadians` (pi / 2: a hemisphere), outwards.
TriangleMesh openSphereMesh(int rings, double openingRadians);
/// Torus about z with radii 1 and 0.35.
TriangleMesh torusMesh(int segments);
/// Box of 12 triangles centred at the origin.
TriangleMesh boxMesh(const Eigen::Vector3d& size);
/// Flat square sheet of n x n quads with side 1 in the plane z = 0.
TriangleMesh sheetMesh(int n);
/// Ball with smooth bumps at two scales, ridges, and a tail: concave, with thin parts, like a figurine.
TriangleMesh figurineMesh(int rings);
/// Sphere with a fin 0.001 thick and 1 long.
TriangleMesh finnedSphereMesh();

/// Both meshes in one, sharing nothing.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
/// All triangles turned.
TriangleMesh invertedMesh(TriangleMesh mesh);
/// About half the triangles turned, the same ones every time.
TriangleMesh shuffledOrientation(TriangleMesh mesh);
/// Every triangle with three vertices of its own.
TriangleMesh unwelded(const TriangleMesh& mesh);
/// Every position becomes scale * p + offset.
TriangleMesh transformed(TriangleMesh mesh, double scale, const Eigen::Vector3d& offset);

}  // namespace tetskin::test
