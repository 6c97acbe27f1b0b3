// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Reads meshes; reads and writes tet meshes, cages and embeddings.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>

#include <cstddef>
#include <string>
#include <vector>

namespace tetskin {

/// The parts of a mesh file that were not read as they are. Also written if reading fails, up to the point of failure.
struct TETSKIN_IO_API MeshFileReport {
  /// Faces of one kind.
  struct Faces {
    std::size_t count = 0;      ///< number of them
    std::size_t firstLine = 0;  ///< line of the first one, from 1 (undefined where the count is 0)
  };
  Faces droppedFaces;     ///< faces of an `.obj` file with fewer than three corners
  Faces incompleteFaces;  ///< faces that name texture coordinates or normals that the file lacks: read without these

  /// Readable summary in one line; empty if everything was read.
  std::string describe() const;
};

/// Reads a render mesh.
///
/// `.obj` files (in any case) are read as they are: vertices in the file's order, including unused ones; polygons split
/// into triangles; groups by `g`, `o` and `usemtl`; texture coordinates and normals if every vertex has exactly one.
///
/// `.ply`, `.off` and `.stl` files are also read as they are: vertices in the file's order (three per triangle of an
/// `.stl` file), polygons split into triangles, no groups, vertex normals if the file has them, and texture coordinates
/// of a `.ply` file.
///
/// `.gltf`, `.glb` and `.vrm` files of glTF 2.0 are read by tinygltf, everything else (FBX, Collada, 3DS, ...) by
/// assimp, except glTF 1.0 and 3MF; with the transforms of their scenes:
/// - every mesh once for each node that shows it, transformed, as one group, or as one for each primitive of a glTF
///   mesh, which share its vertices; in the file's own unit;
/// - vertices are those of the file, for assimp those that it creates, none merged; those of lines and points are left
///   out, as are bones, morph targets and animations;
/// - if only some of the meshes have texture coordinates, the others get 0; if only some have normals, the others get
///   smooth ones, weighted by area. Normals have unit length, or are 0 if the file's are invalid.
///
/// In a build with TETSKIN_ASSIMP=OFF, formats that assimp would read give UnsupportedFormat.
///
/// The buffers of a glTF file are read only from its own folder and those below it; images and other data that do not
/// affect the shape are not read. An unsupported extension that the file requires is named in the error
/// (KHR_mesh_quantization is supported, compressed meshes are not).
///
/// report  what was left out, if not null
///
/// Errors: FileNotFound, UnsupportedFormat, Malformed, IndexOutOfRange, NonFinite (also for a coordinate beyond
/// Limits::kMaxCoordinate), and Empty if there are no vertices or no triangles. The message names the file, and the
/// line of an `.obj` or an ASCII `.ply` file. Throws nothing.
TETSKIN_IO_API Result<TriangleMesh> loadMesh(const std::string& path, MeshFileReport* report = nullptr);

/// Reads a map painted on a mesh: one number per vertex, in the order of `loadMesh`, for `paintCage` and others.
///
/// name    of a property of the vertices of a `.ply` file, or of an attribute `_NAME` of one number of a `.gltf`,
///         `.glb` or `.vrm` file, case as there; or `red`, `green`, `blue` or `alpha`, of the vertex colours of these
///         (COLOR_0) and of an `.obj` file (`v x y z r g b`): from 0 to 1, also if the file has integers;
///         negative integers stay negative
/// Cost    that of `loadMesh`
/// Errors  those of `loadMesh`; InvalidOption if the file has no such map (the message names those that it has), or
///         for only some of its vertices, or two for some; UnsupportedFormat for other formats
TETSKIN_IO_API Result<std::vector<double>> loadVertexMap(const std::string& path, const std::string& name);

/// The parts of a tet file that were not read as they are. Also written if reading fails, up to the point of failure.
struct TETSKIN_IO_API TetFileReport {
  std::size_t skippedCells = 0;   ///< cells that are not tets: surfaces, lines, hexahedra, ...
  std::size_t quadraticTets = 0;  ///< tets of second order that became quadratic ones, of eight tets each
  std::size_t movedNodes = 0;     ///< nodes on curved edges that were moved to the middle, to make the edge straight
  double farthestMove = 0.0;      ///< the largest distance of such a move, in the file's unit

  /// Readable summary in one line; empty if everything was read.
  std::string describe() const;
};

/// Reads a tet mesh; the extension, in any case, selects the format:
/// - `.vtk`          legacy VTK, ASCII or binary, versions 1.0 to 5.1, of an unstructured grid; deviations from the
///                   standard as in Bullet's own files are accepted
/// - `.node`, `.ele` TetGen: given either one, the other is found beside it; numbered from 0 or 1
///
/// Convert others, such as Gmsh's `.msh`, with `meshio convert in.msh out.vtk`.
///
/// Nodes and tets are in the file's order and unit. Cells that are not tets are skipped. Each tet of second order (VTK
/// type 24, and 71 and 79 with 10 nodes) becomes eight tets, with the nodes on its edges, wherever these are. `report`
/// counts all of these. Tets of higher order are refused, as are tets of first order that share an edge with ones of
/// second order. In the result, every index names a node and no coordinate is beyond Limits::kMaxCoordinate; for other
/// faults see `checkTetMesh`.
///
/// Cost: linear; memory is bounded by the size of the file, whatever counts it states.
///
/// Errors: FileNotFound; UnsupportedFormat; with the line: Malformed, IndexOutOfRange, NonFinite; Empty without tets.
TETSKIN_IO_API Result<TetMesh> loadTetMesh(const std::string& path, TetFileReport* report = nullptr);

/// Writes a tet mesh, complete or not at all; the extension, in any case, selects the format:
/// - `.vtk`          legacy VTK 2.0, ASCII, one point per line and tets only, so that Bullet's reader accepts it
/// - `.node`, `.ele` both TetGen files, given either; numbered from 0, as Bullet's reader expects
///
/// Coordinates are the shortest numbers that read back as the same doubles: `loadTetMesh` gives the same mesh. Errors:
/// UnsupportedFormat; Empty without tets; IndexOutOfRange and NonFinite, because no reader would accept the file;
/// FileNotWritable.
TETSKIN_IO_API Status saveTetMesh(const TetMesh& mesh, const std::string& path);

/// Reads a cage: what `loadTetMesh` reads and, from a `.vtk` file, also the data that `saveCage` writes. The eight tets
/// from one of second order become a quadratic tet (see `quadraticTets`), unless it is flat; to make its edges
/// straight, nodes on them are moved to their middles. Data that is absent stays empty; arrays with other names are
/// skipped, as are values of cells that are not tets. If the file stores which mesh the cage belongs to,
/// `Cage::checkMesh` compares it.
///
/// Cost: linear; memory is bounded by the size of the file. Errors: those of `loadTetMesh`; for an array with one of
/// these names but a wrong count, type or value: Malformed, SizeMismatch, InvalidOption, IndexOutOfRange.
TETSKIN_IO_API Result<Cage> loadCage(const std::string& path, TetFileReport* report = nullptr);

/// Writes a cage: the file of `saveTetMesh`, followed, in a `.vtk` file, by all data of the cage, so that `loadCage`
/// gives a bit-identical cage:
/// - FIELD:      `mesh_hash` (unsigned_int, upper and lower 32 bits), `vertex_tets` (int, one per vertex of the mesh)
/// - CELL_DATA:  `fill`, `factor`, `painted_stiffness`, `painted_density`, `painted_damping` (double), `part`,
///   `lattice_tet`, `quadratic_tet` (int), `fine_fill` (unsigned_char, kFineTets per tet): volumeFraction,
///   stiffnessFactor, paintedStiffness, paintedDensity, paintedDamping, component, sourceTet, quadraticTet and
///   fineVolumeFraction
/// - POINT_DATA: `mass` (double)
///
/// ParaView shows these arrays; Bullet's reader and simple programs stop before them. A cage without data gives the
/// file of `saveTetMesh`. The other formats store only the tets.
///
/// Errors: those of `saveTetMesh` and of `validate(const Cage&)`; UnsupportedFormat if `vertexTets` of a cage with
/// duplicate elements would be lost, because only `.vtk` stores it.
TETSKIN_IO_API Status saveCage(const Cage& cage, const std::string& path);

/// Writes the bytes of `Embedding::save` to a file, complete or not at all. The embedding must not be empty.
/// cage    the cage with which it was made
/// Errors  FileNotWritable
TETSKIN_IO_API Status saveEmbedding(const Embedding& embedding, const TetMesh& cage, const std::string& path);

/// Reads a file written by `saveEmbedding`; see `Embedding::load` for what is checked. The caller should compare
/// vertexCount() with the mesh's.
/// cage    the cage with which it was saved, bit-identical: from the same file, or the same call of `createCage`
/// Errors  FileNotFound; those of `Embedding::load`, with the path in front
TETSKIN_IO_API Result<Embedding> loadEmbedding(const std::string& path, const TetMesh& cage);

}  // namespace tetskin
