// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A function for each format of meshes.
#pragma once

#include <tetskin/io/files.h>

#include <string>

namespace tetskin::io {

/// Reads a Wavefront OBJ file the way the file has it:
/// - positions are the `v` lines in their order, exact in double, also those that no face names;
/// - triangles are the faces in their order. A convex polygon is fanned from its first corner, a concave one is cut by
///   clipping ears (see `io/polygon.h`);
/// - groups are the runs of faces with the same name, that of the last `g` or `o`, and the same `usemtl`;
/// - texcoords (and normals, made unit) are given if every vertex in a face has exactly one value, else left empty;
///   vertices in no face get 0, and so do values that are not finite. References to missing ones count as none.
/// Lines, points, faces of fewer than three corners, curves and unknown statements are skipped.
/// report  counts faces that were not read as they are
/// Cost: linear, about 20 ms for 60,000 triangles.
/// Errors: FileNotFound; with the line: Malformed, IndexOutOfRange, NonFinite; Empty without vertices or faces.
Result<TriangleMesh> readObj(const std::string& path, MeshFileReport& report);

/// Reads a PLY file, ASCII or binary of either byte order, without changes: every vertex in the file's order; polygons
/// and triangle strips cut into triangles, faces of fewer than three corners left out; normals (nx, ny, nz), and
/// texture coordinates of vertices (s t, u v or texture_u texture_v), or of faces' corners (texcoord) if every vertex
/// has one of its own.
///
/// Cost: linear, but for concave polygons (see `appendPolygon`); memory is bounded by the size of the file, whatever
/// counts it states.
///
/// Errors: as `loadMesh`. Messages of ASCII files name the line.
Result<TriangleMesh> readPly(const std::string& path);

/// Reads an OFF file of text without changes: every vertex in the file's order; polygons cut into triangles, faces of
/// fewer than three corners left out; normals of an NOFF file. What stands behind the coordinates of a vertex and the
/// corners of a face (colours, texture coordinates) is ignored.
///
/// Cost: linear, but for concave polygons (see `appendPolygon`); memory is bounded by the size of the file.
///
/// Errors: as `loadMesh`; the message names the line.
Result<TriangleMesh> readOff(const std::string& path);

/// Reads an STL file, binary or text, as it stands there: three vertices for every triangle, in the file's order. Its
/// normals are left out, as those of the triangles are known.
///
/// Cost: linear; memory is bounded by the size of the file.
///
/// Errors: as `loadMesh`.
Result<TriangleMesh> readStl(const std::string& path);

/// Why this build cannot read or write glTF: it was made without tinygltf. Empty if it can.
std::string whyNoGltf();

/// Reads a `.gltf`, `.glb` or `.vrm` file as `loadMesh` describes. Throws nothing. Defined only if `whyNoGltf` is
/// empty.
Result<TriangleMesh> readGltf(const std::string& path);

/// Reads any format that assimp reads, as `loadMesh` describes. In a build without assimp: UnsupportedFormat, if there
/// is such a file. Throws nothing.
Result<TriangleMesh> readWithAssimp(const std::string& path);

}  // namespace tetskin::io
