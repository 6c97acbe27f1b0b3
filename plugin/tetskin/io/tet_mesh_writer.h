// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/tet_mesh.h>

#include <string>

namespace tetskin {

/// Writes a tet mesh, complete or not at all; the extension, in any case, tells the format:
/// - `.vtk`          legacy VTK 2.0, ASCII, one point a line and tets only, so that Bullet's reader takes it
/// - `.node`, `.ele` both TetGen files, given either; counting from 0, as Bullet's reader expects
/// - `.msh`          Gmsh 2.2, ASCII: the version that most programs read
///
/// Coordinates are the shortest numbers that read back as the same doubles: `loadTetMesh` gives the same mesh.
/// Errors: UnsupportedFormat; Empty without tets; IndexOutOfRange and NonFinite, as no reader would take the file;
/// FileNotWritable.
Status saveTetMesh(const TetMesh& mesh, const std::string& path);

}  // namespace tetskin
