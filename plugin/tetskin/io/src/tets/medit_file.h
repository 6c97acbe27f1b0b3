// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/src/tets/high_order_tets.h>

#include <string>

namespace tetskin::io {

/// Reads a Medit file of text as `loadTetMesh` describes. If the file contains no tets, the cage has none.
Result<FileCage> readMeditFile(const std::string& path, TetFileReport& report);

}  // namespace tetskin::io
