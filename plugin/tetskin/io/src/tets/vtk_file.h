// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/tet_files.h>

#include <string>

namespace tetskin::io {

/// Which of a file's data to read: its tets alone, or also what `saveCage` writes with them.
enum class VtkData { Skipped, OfCage };

/// Reads a legacy VTK file as `loadTetMesh` and `loadCage` describe. A file without tets gives a cage without tets.
Result<Cage> readVtkFile(const std::string& path, VtkData data, TetFileReport& report);

}  // namespace tetskin::io
