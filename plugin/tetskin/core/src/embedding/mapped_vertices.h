// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// The tet of every vertex from the cage's map, without a search, in the convention of `embeddingFromTets`. Also fills
/// in the report's entries about vertices outside: those that rounding, for instance to float, has put there. Vertices
/// that no triangle uses may be anywhere.
/// cage     with `vertexTets`; usable
/// Errors   CageMismatch: the map belongs to another mesh; Degenerate: it names a flat tet; those of
///          `validateAttributes`
Result<std::vector<std::int32_t>> mappedTets(const Cage& cage, const TriangleMesh& mesh, EmbedReport& report);

}  // namespace tetskin
