// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The tolerances of the search.
#pragma once

namespace tetskin {

/// Weight above which a vertex counts as deep inside a tet: keeps shared faces from counting as overlap.
constexpr double kOverlapDepth = 1e-6;
/// Tets whose distances differ by less than this fraction of their size are equally near.
constexpr double kNearestTie = 1e-6;
/// A vertex whose distance to the nearest tet is at most this fraction of the cage's largest coordinate (4 to 8 units
/// in its last place) is inside: the error of a vertex computed to lie on a face is as large.
constexpr double kInsideTolerance = 0x1p-49;
/// Absolute weight above which a vertex outside looks for a better tet than the nearest, which is thin or far away.
constexpr double kMaxWeight = 4.0;

}  // namespace tetskin
