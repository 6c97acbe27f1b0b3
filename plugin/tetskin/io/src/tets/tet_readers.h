// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A function for each format of tets.
#pragma once

#include <tetskin/io/src/tets/high_order_tets.h>

#include <string>

namespace tetskin::io {

/// Reads a legacy VTK file as `loadTetMesh` and `loadCage` describe. If the file contains no tets, the cage has none.
Result<FileCage> readVtkFile(const std::string& path, ReadAs as, TetFileReport& report);

/// Reads a pair of TetGen files, given the path of either, as `loadTetMesh` describes. If they contain no tets, the
/// mesh has none.
Result<FileCage> readTetgenFiles(const std::string& path);

}  // namespace tetskin::io
