// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: finds which tet carries which point.
#pragma once

#include <tetskin/core/src/base/point_reader.h>
#include <tetskin/core/src/search/search_cage.h>
#include <tetskin/core/src/search/tolerances.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tetskin {

struct TetSearch {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

  std::vector<std::int32_t> tetOf;  ///< by point: its tet, or ~tet if it lies outside of it; kNone: not yet found
  std::size_t overlapping = 0;      ///< points deeper than kOverlapDepth in two tets or more
  std::size_t candidates = 0;       ///< pairs tested
  double farthestDistance = 0.0;    ///< longest distance of a point outside to the nearest tet; see `worstDistance`
  std::uint32_t farthest = 0;       ///< index of that point: the first, if there are several
  std::vector<bool> reassigned;     ///< by point: true if it is outside, and not in the nearest tet because of its
                                    ///< weights; empty if there are none
};

/// Finds the tet of every point by the rule that `embed` states. There must be a tet; points must be finite.
/// first      by point, see `weldCoincident`: only points that are their own first are searched; the others copy them
/// tableSize  of the spatial hash, see there; only the cost depends on it
TetSearch findTets(const SearchCage& cage, PointReader points, const std::vector<std::uint32_t>& first,
                   OutsideRule rule, std::size_t tableSize = 0);

}  // namespace tetskin
