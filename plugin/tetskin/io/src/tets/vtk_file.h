// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/tet_files.h>

#include <string>

namespace tetskin::io {

/// Reads a legacy VTK file as `loadTetMesh` describes. A file without tets gives a mesh without tets.
Result<TetMesh> readVtkFile(const std::string& path, TetFileReport& report);

}  // namespace tetskin::io
