// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/tet_mesh.h>

#include <cstddef>
#include <string>

namespace tetskin {

/// What a file held besides the tets that were read. Filled also if reading fails, as far as it came.
struct TETSKIN_IO_API TetFileReport {
  std::size_t skippedCells = 0;      ///< cells that are no linear tets: surfaces, lines, hexahedra, quadratic tets, ...
  std::size_t skippedHighOrder = 0;  ///< of these, tets with nodes on their edges

  /// One line for people; empty if nothing was skipped.
  std::string describe() const;
};

/// Reads a tet mesh; the extension, in any case, tells the format:
/// - `.vtk`          legacy VTK, ASCII or binary, versions 1.0 to 5.1, of an unstructured grid; also as loosely written
///                   as Bullet's own files
/// - `.node`, `.ele` TetGen: given either, the other is found beside it; counted from 0 or 1; corners of 10-node tets
/// - `.msh`          Gmsh, ASCII, versions 2.x and 4.1
///
/// Nodes and tets are in the file's order and unit. Cells other than tets of 4 nodes are skipped and counted in
/// `report`, also tets with more nodes (VTK types 24 and 71, Gmsh type 11, ...). In what is returned, every index names
/// a node and no coordinate is beyond kLargestCoordinate; for all else see `checkTetMesh`.
///
/// Cost: linear; memory is bounded by the size of the file, whatever counts it states.
///
/// Errors: FileNotFound; UnsupportedFormat; with the line: Malformed, IndexOutOfRange, NonFinite; Empty without tets.
TETSKIN_IO_API Result<TetMesh> loadTetMesh(const std::string& path, TetFileReport* report = nullptr);

/// Writes a tet mesh, complete or not at all; the extension, in any case, tells the format:
/// - `.vtk`          legacy VTK 2.0, ASCII, one point a line and tets only, so that Bullet's reader takes it
/// - `.node`, `.ele` both TetGen files, given either; counting from 0, as Bullet's reader expects
/// - `.msh`          Gmsh 2.2, ASCII: the version that most programs read
///
/// Coordinates are the shortest numbers that read back as the same doubles: `loadTetMesh` gives the same mesh.
/// Errors: UnsupportedFormat; Empty without tets; IndexOutOfRange and NonFinite, as no reader would take the file;
/// FileNotWritable.
TETSKIN_IO_API Status saveTetMesh(const TetMesh& mesh, const std::string& path);

/// Reads a cage: what `loadTetMesh` reads, and from a `.vtk` file also what `saveCage` writes into it. What is not
/// there is not known; arrays of other names are skipped; values of cells that are no tets are, too. Which mesh the
/// cage is for it may know: see `Cage::checkMesh`.
///
/// Cost: linear, as above. Errors: those of `loadTetMesh`; an array by one of these names that has the wrong count,
/// type or values: Malformed, SizeMismatch, InvalidOption, IndexOutOfRange.
TETSKIN_IO_API Result<Cage> loadCage(const std::string& path, TetFileReport* report = nullptr);

/// Writes a cage: the file of `saveTetMesh`, and behind that, in a `.vtk` file, all that is known, so that `loadCage`
/// gives the same cage, to the bit:
/// - FIELD:      `mesh_hash` (unsigned_int, upper and lower 32 bits), `vertex_tets` (int, one a vertex of the mesh)
/// - CELL_DATA:  `fill`, `factor` (double), `part`, `lattice_tet` (int), `fine_fill` (unsigned_char, kFineTets a tet)
/// - POINT_DATA: `mass` (double)
/// ParaView shows these, Bullet's reader and simple programs stop before them. A bare cage makes the file of
/// `saveTetMesh`. The other formats keep the tets alone.
///
/// Errors: those of `saveTetMesh` and of `Cage::check`; UnsupportedFormat if the map of a cage with copies of tets
/// would be lost, for only `.vtk` keeps it.
TETSKIN_IO_API Status saveCage(const Cage& cage, const std::string& path);

}  // namespace tetskin
