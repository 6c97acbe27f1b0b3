// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/files.h>

#include <string>

namespace tetskin::io {

/// Reads a pair of TetGen files, given the path of either, as `loadTetMesh` describes. If they contain no tets, the
/// mesh has none.
Result<Cage> readTetgenFiles(const std::string& path, TetFileReport& report);

}  // namespace tetskin::io
