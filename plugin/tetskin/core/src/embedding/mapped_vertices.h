// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// The tet of every vertex by the cage's map, in the convention of `embeddingFromTets`; no search. What the report has
/// of vertices outside is filled in: those that rounding, as to float, has put there. Vertices that no triangle uses
/// may be anywhere.
/// cage     with `vertexTets`; usable
/// Errors   CageMismatch: the map is of another mesh; Degenerate: it names a flat tet; those of `validateAttributes`
Result<std::vector<std::int32_t>> mappedTets(const Cage& cage, const TriangleMesh& mesh, EmbedReport& report);

}  // namespace tetskin
