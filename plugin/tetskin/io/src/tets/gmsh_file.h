// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/tet_files.h>

#include <string>

namespace tetskin::io {

/// Reads an ASCII file of Gmsh as `loadTetMesh` describes. A file without tets gives a mesh without tets.
Result<TetMesh> readGmshFile(const std::string& path, TetFileReport& report);

}  // namespace tetskin::io
