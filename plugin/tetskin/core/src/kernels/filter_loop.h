// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: the search's filter.
#pragma once

#include <tetskin/core/src/kernels/points.h>
#include <tetskin/core/src/kernels/search_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <int W>
struct WidePlane {
  float x, y, z, constant;
  Lanes<float, W> at(const Lanes<float, W> p[3]) const { return (x * p[0] + y * p[1]) + (z * p[2] + constant); }
};

/// Appends first + k for every lane k < count that is not negative; returns the new end. Without a branch, which would
/// be mispredicted at every hit.
template <int W>
TETSKIN_INLINE std::uint32_t* appendNotNegative(const Lanes<float, W>& v, std::uint32_t first, std::uint32_t count,
                                                std::uint32_t* out) {
#if defined(__AVX512F__)
  if constexpr (W == 16) {
    __mmask16 keep = _mm512_cmp_ps_mask(v, _mm512_setzero_ps(), _CMP_NLT_UQ);
    if (count < 16) keep = static_cast<__mmask16>(keep & ((1u << count) - 1u));
    const __m512i numbers = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i entries = _mm512_add_epi32(numbers, _mm512_set1_epi32(static_cast<int>(first)));
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(keep, entries));
    return out + _mm_popcnt_u32(keep);
  }
#endif
  const unsigned negative = negativeLanes<W>(v);
  for (std::uint32_t k = 0; k < W; ++k) {
    *out = first + k;
    out += static_cast<unsigned>(k < count) & ~(negative >> k) & 1u;
  }
  return out;
}

template <int W>
std::size_t selectEntries(const FilterWork& work, std::uint32_t* selected) {
  static_assert(W <= kMaxLanes, "so many may be read and written beyond the end");
  WidePlane<W> planes[4];
  for (int i = 0; i < 4; ++i) planes[i] = {work.normal[i][0], work.normal[i][1], work.normal[i][2], work.constant[i]};
  std::uint32_t* out = selected;
  for (const EntryRange* range = work.ranges; range != work.ranges + work.rangeCount; ++range) {
    for (std::uint32_t e = range->first; e < range->last; e += W) {
      const Lanes<float, W> p[3] = {load<W>(work.points[0] + e), load<W>(work.points[1] + e),
                                    load<W>(work.points[2] + e)};
      Lanes<float, W> bound =
          smaller(smaller(planes[0].at(p), planes[1].at(p)), smaller(planes[2].at(p), planes[3].at(p)));
      if (work.limits) bound += load<W>(work.limits + e);
      out = appendNotNegative<W>(bound, e, range->last - e, out);
    }
  }
  return static_cast<std::size_t>(out - selected);
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
