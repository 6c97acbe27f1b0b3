// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: positions, and their box.
#pragma once

#include <tetskin/core/kernels/blocks.h>
#include <tetskin/core/kernels/tet_maps.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int W>
struct WideExtent {
  Lanes<S, W> low[3], high[3];

  explicit WideExtent(const Extent<S>& from) {
    for (int k = 0; k < 3; ++k) {
      low[k] = all<S, W>(from.low[k]);
      high[k] = all<S, W>(from.high[k]);
    }
  }
  /// Of the first `count` lanes only: the others belong to other tets.
  void add(const Lanes<S, W> x[3], int count) {
    const auto counted = laneNumbers<S, W>() < static_cast<S>(count);
    for (int k = 0; k < 3; ++k) {
      low[k] = (counted & (x[k] < low[k])) ? x[k] : low[k];
      high[k] = (counted & (x[k] > high[k])) ? x[k] : high[k];
    }
  }
  void mergeInto(Extent<S>& to) const {
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < W; ++i) {
        const S a = lane<S, W>(low[k], i), b = lane<S, W>(high[k], i);
        if (a < to.low[k]) to.low[k] = a;
        if (b > to.high[k]) to.high[k] = b;
      }
    }
  }
};

/// One for each width of blocks.
template <class S, int W>
struct WideExtents : WideExtents<S, narrower(W)> {
  using Narrower = WideExtents<S, narrower(W)>;
  WideExtent<S, W> wide;

  explicit WideExtents(const Extent<S>& from) : Narrower(from), wide(from) {}
  void mergeInto(Extent<S>& to) const {
    Narrower::mergeInto(to);
    wide.mergeInto(to);
  }
};
template <class S>
struct WideExtents<S, 1> {
  WideExtent<S, 1> wide;

  explicit WideExtents(const Extent<S>& from) : wide(from) {}
  void mergeInto(Extent<S>& to) const { wide.mergeInto(to); }
};

template <class S, int Widest, class Tet, bool kExtent>
void positionsOf(const Work<S>& given, const S shift[3], S* out, Extent<S>* extent) {
  const Work<S> work = given;  // a copy, which the compiler knows that no store to `out` can change
  const S padded[4] = {shift[0], shift[1], shift[2], S(0)};
  const std::uint32_t end = work.runs[work.lastRun].firstSlot;
  WideExtents<S, Widest> extents(kExtent ? *extent : Extent<S>{});
  forAllBlocks<Widest, Tet>(
      work, [&](Tet& tet, std::size_t run) { tet.make(work, run, loadPadded(padded)); },
      [&](const Tet& tet, auto width, std::uint32_t slot, int count) {
        constexpr int W = decltype(width)::value;
        Lanes<S, W> x[3];
        tet.template positions<W>(work, slot, x);
        if (kExtent) static_cast<WideExtents<S, W>&>(extents).wide.add(x, count);
        S* to = out + 3 * static_cast<std::size_t>(slot);
        // Lanes beyond the run's end spill into slots that the next run writes again: cheaper than to hold back.
        if (slot + W <= end) {
          storePoints<S, W>(x, to);
        } else {
          storeOneByOne<S, W>(x[0], x[1], x[2], nullptr, count, to);
        }
      });
  if (kExtent) extents.mergeInto(*extent);
}

template <class S, int W, class Tet>
void positionsOf(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  return extent ? positionsOf<S, W, Tet, true>(work, shift, out, extent)
                : positionsOf<S, W, Tet, false>(work, shift, out, extent);
}

template <class S, int W>
void positions(const Work<S>& work, const S shift[3], S* out, Extent<S>* extent) {
  switch (work.surface) {
    case Surface::Linear:
      return positionsOf<S, W, LinearTet<S>>(work, shift, out, extent);
    case Surface::Quadratic:
      return positionsOf<S, W, QuadraticTet<S>>(work, shift, out, extent);
    case Surface::QuadraticOutside:
      return positionsOf<S, W, QuadraticTetOutside<S>>(work, shift, out, extent);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
