// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Well-formed and damaged triangle meshes for the tests of the cage builder.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::test {

constexpr double kPi = 3.14159265358979323846;

/// Unit sphere about the origin; see `sphere` in tests/support.
TriangleMesh unitSphere(int rings);
/// The part of a unit sphere with polar angles up to `openingRadians` (pi / 2: a hemisphere), facing outwards.
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

/// Both meshes in one; they share no vertices.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
/// The mesh with all triangles reversed.
TriangleMesh invertedMesh(TriangleMesh mesh);
/// The mesh with about half of the triangles reversed, the same ones each time.
TriangleMesh shuffledOrientation(TriangleMesh mesh);
/// The mesh with three separate vertices for each triangle.
TriangleMesh unwelded(const TriangleMesh& mesh);
/// The mesh with each position p replaced by scale * p + offset.
TriangleMesh transformed(TriangleMesh mesh, double scale, const Eigen::Vector3d& offset);

}  // namespace tetskin::test
