// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A function for each format of meshes.
#pragma once

#include <tetskin/io/files.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::io {

/// A map of one number per vertex that is read along with a mesh: see `loadVertexMap`.
struct MapRequest {
  std::string name;
  std::vector<double> values;     ///< of vertices, in the order of the mesh; fewer than these if some have none
  std::set<std::string> present;  ///< names that the file has
};

/// 0 to 3 for red, green, blue and alpha, the names of a vertex colour's channels in all formats; -1 for others.
int colourChannel(std::string_view name);

/// Reads a Wavefront OBJ file as it is:
/// - positions are the `v` lines in order, exact in double, including those that no face names;
/// - triangles are the faces in order. A convex polygon is fanned from its first corner, a concave one is cut by
///   clipping ears (see `appendPolygon`);
/// - groups are the runs of faces with the same name (of the last `g` or `o`) and the same `usemtl`;
/// - texcoords (and normals, normalised) are given if every vertex in a face has exactly one value, otherwise left
///   empty; vertices in no face get 0, as do values that are not finite. A reference to a missing one is no value.
/// Lines, points, faces of fewer than three corners, curves and unknown statements are skipped.
/// report  counts faces that were not read as they are
/// Cost: linear, about 20 ms for 60,000 triangles.
/// Errors: FileNotFound; with the line: Malformed, IndexOutOfRange, NonFinite; Empty without vertices or faces.
Result<TriangleMesh> readObj(const std::string& path, MeshFileReport& report, MapRequest* map = nullptr);

/// Reads a PLY file, ASCII or binary of either byte order, without changes: every vertex in the file's order; polygons
/// and triangle strips cut into triangles, faces of fewer than three corners left out; normals (nx, ny, nz), and
/// texture coordinates of vertices (s t, u v or texture_u texture_v), or of faces' corners (texcoord) if every vertex
/// has exactly one.
///
/// Cost: linear, except for concave polygons (see `appendPolygon`); memory is bounded by the size of the file, whatever
/// counts it states.
///
/// Errors: as `loadMesh`. Messages of ASCII files name the line.
Result<TriangleMesh> readPly(const std::string& path, MapRequest* map = nullptr);

/// Reads an OFF text file without changes: every vertex in the file's order; polygons cut into triangles, faces of
/// fewer than three corners left out; normals of an NOFF file. Anything after the coordinates of a vertex and the
/// corners of a face (colours, texture coordinates) is ignored.
///
/// Cost: linear, except for concave polygons (see `appendPolygon`); memory is bounded by the size of the file.
///
/// Errors: as `loadMesh`; the message names the line.
Result<TriangleMesh> readOff(const std::string& path);

/// Reads an STL file, binary or text, as it is: three vertices for every triangle, in the file's order. Its normals are
/// left out, because those of the triangles can be computed.
///
/// Cost: linear; memory is bounded by the size of the file.
///
/// Errors: as `loadMesh`.
Result<TriangleMesh> readStl(const std::string& path);

/// Why this build cannot read or write glTF: it was built without tinygltf. Empty if it can.
std::string whyNoGltf();

/// Reads a `.gltf`, `.glb` or `.vrm` file as `loadMesh` describes. Throws nothing. Defined only if `whyNoGltf` is
/// empty.
Result<TriangleMesh> readGltf(const std::string& path, MapRequest* map = nullptr);

/// Reads any format that assimp reads, as `loadMesh` describes. Without assimp: UnsupportedFormat, if there is such a
/// file. Throws nothing.
Result<TriangleMesh> readWithAssimp(const std::string& path);

}  // namespace tetskin::io
