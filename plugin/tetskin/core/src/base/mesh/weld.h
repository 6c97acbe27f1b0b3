// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/point_reader.h>
#include <tetskin/core/types.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// For every point, the index of the first point at exactly the same position (its own, if it is the first). Texture
/// and normal seams, and every triangle of an STL file, duplicate vertices this way. 0 and -0 are the same. Points must
/// be finite. Cost O(count) expected, in sequential passes; 8 bytes per point while it works, and up to 16 more if most
/// points coincide.
TETSKIN_CORE_API std::vector<std::uint32_t> weldCoincident(PointReader points);

}  // namespace tetskin
