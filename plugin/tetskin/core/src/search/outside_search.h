// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: the second pass of `findTets`.
#pragma once

#include <tetskin/core/src/search/tet_search.h>

namespace tetskin {

/// Finds the tet of every point that is its own first and that the first pass has left without one. Arguments as in
/// `findTets`; `cellSize` is the first pass's.
void findOutside(const SearchCage& cage, PointReader points, const std::vector<std::uint32_t>& first, OutsideRule rule,
                 double cellSize, std::size_t tableSize, TetSearch& search);

}  // namespace tetskin
