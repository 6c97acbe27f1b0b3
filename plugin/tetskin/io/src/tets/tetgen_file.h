// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/tet_files.h>

#include <string>

namespace tetskin::io {

/// Reads a pair of TetGen files, given either, as `loadTetMesh` describes. A file without tets gives a mesh without
/// tets.
Result<TetMesh> readTetgenFiles(const std::string& path, TetFileReport& report);

}  // namespace tetskin::io
