// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: the inner loop of the search, compiled once for each instruction set and chosen at run time;
// the restrictions of skinning_kernels.h apply to this header, too.
#pragma once

#include <tetskin/core/src/base/kernels/dispatch.h>

#include <cstddef>
#include <cstdint>

namespace tetskin::kernels {

/// The entries [first, last) of a hash.
struct EntryRange {
  std::uint32_t first, last;
};

/// Input of the filter that keeps the entries that are beyond none of four planes.
struct FilterWork {
  const EntryRange* ranges = nullptr;
  std::size_t rangeCount = 0;
  const float* points[3] = {};    ///< arrays of coordinates, by entry; kMaxLanes more may be read
  const float* limits = nullptr;  ///< by entry, padded: tolerance of the planes; null: 0
  float normal[4][3] = {};
  float constant[4] = {};
};
/// Floats in the widest register, that of AVX-512: loops may read and write this many beyond the end.
constexpr std::size_t kMaxLanes = 16;

/// Writes the entries for which no normal . point + constant + limit is negative, in order, and returns their number.
/// May write kMaxLanes more.
using SelectEntries = std::size_t (*)(const FilterWork&, std::uint32_t* selected);

TETSKIN_FOR_EACH_INSTRUCTION_SET(extern const SelectEntries select;)

}  // namespace tetskin::kernels
