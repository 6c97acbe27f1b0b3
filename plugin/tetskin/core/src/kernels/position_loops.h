// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: positions, and their box.
#pragma once

#include <tetskin/core/src/kernels/tet_maps.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int P>
struct WideExtent {
  Points<S, P> low, high;

  explicit WideExtent(const Extent<S>& from) {
    const S lowest[4] = {from.low[0], from.low[1], from.low[2], S(0)};
    const S highest[4] = {from.high[0], from.high[1], from.high[2], S(0)};
    low = repeated<S, P>(lowest);
    high = repeated<S, P>(highest);
  }
  /// Adds the first `count` points: any further ones belong to other tets.
  void add(const Points<S, P>& x, std::size_t count) {
    if constexpr (P == 1) {
      low = smaller(x, low);
      high = larger(x, high);
    } else {
      const auto counted = laneNumbers<S, 4 * P>() < static_cast<S>(4 * atMost<P>(count));
      low = smaller(counted ? x : low, low);
      high = larger(counted ? x : high, high);
    }
  }
  void mergeInto(Extent<S>& to) const {
    for (int i = 0; i < P; ++i) {
      for (int k = 0; k < 3; ++k) {
        if (low[4 * i + k] < to.low[k]) to.low[k] = low[4 * i + k];
        if (high[4 * i + k] > to.high[k]) to.high[k] = high[4 * i + k];
      }
    }
  }
};

/// kSpill  writes points past a run's end into slots that the next run overwrites: cheaper than masking them
template <class S, int P, class Tet, bool kExtent, bool kSpill>
TETSKIN_NOINLINE void positionsOfRuns(const Work<S>& given, std::size_t firstRun, std::size_t lastRun, const S shift[4],
                                      S* out, WideExtent<S, P>& extent) {
  const Work<S> work = given;  // copies, so that the compiler knows that no store to `out` changes them
  WideExtent<S, P> reached = extent;
  const Points<S, P> shifts = repeated<S, P>(shift);
  for (std::size_t r = firstRun; r < lastRun; ++r) {
    const Tet tet(work, r);
    const Points<S, P> base = tet.last + shifts;
    const std::size_t runEnd = work.runs[r + 1].firstSlot;
    for (std::size_t slot = work.runs[r].firstSlot; slot < runEnd; slot += P) {
      const Points<S, P> x = base + tet.fromLast(work, slot);
      if (kExtent) reached.add(x, runEnd - slot);
      if (kSpill) {
        storePoints<S, P>(x, out + 3 * slot);
      } else {
        storeFirst<S, P>(x, runEnd - slot, out + 3 * slot);
      }
    }
  }
  extent = reached;
}

template <class S, int P, class Tet, bool kExtent>
void positionsOf(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  const S padded[4] = {shift[0], shift[1], shift[2], S(0)};
  WideExtent<S, P> reached(kExtent ? *extent : Extent<S>{});
  constexpr std::size_t kTouched = kSlotsTouched<P>;
  const std::size_t end = work.runs[work.lastRun].firstSlot;
  std::size_t spilling = work.lastRun;  // runs before this one may write past their end
  while (spilling > work.firstRun && work.runs[spilling].firstSlot + kTouched > end) --spilling;
  positionsOfRuns<S, P, Tet, kExtent, true>(work, work.firstRun, spilling, padded, out, reached);
  positionsOfRuns<S, P, Tet, kExtent, false>(work, spilling, work.lastRun, padded, out, reached);
  if (kExtent) reached.mergeInto(*extent);
}

template <class S, int P, class Tet>
void positionsOf(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  return extent ? positionsOf<S, P, Tet, true>(work, shift, out, extent)
                : positionsOf<S, P, Tet, false>(work, shift, out, extent);
}

template <class S, int P>
void positions(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  switch (work.surface) {
    case Surface::Linear:
      return positionsOf<S, P, LinearTet<S, P>>(work, shift, out, extent);
    case Surface::Quadratic:
      return positionsOf<S, P, QuadraticTet<S, P>>(work, shift, out, extent);
    case Surface::QuadraticOutside:
      return positionsOf<S, P, QuadraticTetOutside<S, P>>(work, shift, out, extent);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
