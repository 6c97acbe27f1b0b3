// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

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

}  // namespace tetskin
