// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>

#include <string>

namespace tetskin {

/// Writes the bytes of `Embedding::save` to a file, complete or not at all. The embedding must not be empty.
/// cage    the one it was made with
/// Errors  FileNotWritable
TETSKIN_IO_API Status saveEmbedding(const Embedding& embedding, const TetMesh& cage, const std::string& path);

/// Reads such a file; see `Embedding::load` for what is checked. The mesh's vertexCount is for the caller to compare.
/// cage    the one it was saved with, to the bit: the same file again, or the same call of `buildCage`
/// Errors  FileNotFound; those of `Embedding::load`, with the path in front
TETSKIN_IO_API Result<Embedding> loadEmbedding(const std::string& path, const TetMesh& cage);

}  // namespace tetskin
