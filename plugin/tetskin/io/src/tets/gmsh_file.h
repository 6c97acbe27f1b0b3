// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/src/tets/high_order_tets.h>

#include <string>

namespace tetskin::io {

/// Reads an ASCII file of Gmsh as `loadTetMesh` describes. If the file contains no tets, the mesh has none.
Result<FileCage> readGmshFile(const std::string& path, TetFileReport& report);

}  // namespace tetskin::io
