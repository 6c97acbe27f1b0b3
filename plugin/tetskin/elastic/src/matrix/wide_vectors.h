// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Sums over vectors in the wide layout, in double; the masses are those of the matrix.
#pragma once

#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <numeric>

namespace tetskin::elastic_detail {

/// Sums side by side, none of which waits for the one before.
struct LaneSums {
  double lanes[kernels::kGroup] = {};

  double total() const { return std::accumulate(lanes, lanes + kernels::kGroup, 0.0); }
};

/// A vector in the wide layout as points, 4 scalars per slot.
template <class S>
void toPoints(const S* wide, AlignedVector<S>& points) {
  bySlots(points.size() / 4, [&](std::size_t slot, std::size_t first) {
    for (std::size_t k = 0; k < 3; ++k) points[4 * slot + k] = wide[first + k * kernels::kGroup];
  });
}

/// v M v, with products rounded to S.
template <class S>
double squaredByMasses(const BlockMatrix<S>& matrix, const S* v) {
  double sum = 0.0;
  bySlots(matrix.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) {
      const S at = v[wide + k * kernels::kGroup];
      sum += static_cast<double>(matrix.massAt(slot) * at * at);
    }
  });
  return sum;
}

/// (a - b) M (a - b).
template <class S>
double squaredDifferenceByMasses(const BlockMatrix<S>& matrix, const S* a, const S* b) {
  LaneSums sums;
  for (std::size_t chunk = 0; chunk < matrix.slotCount() / kernels::kGroup; ++chunk) {
    for (std::size_t lane = 0; lane < kernels::kGroup; ++lane) {
      double squared = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = kernels::kWideVector * chunk + k * kernels::kGroup + lane;
        const auto change = static_cast<double>(a[at] - b[at]);
        squared += change * change;
      }
      sums.lanes[lane] += static_cast<double>(matrix.massAt(kernels::kGroup * chunk + lane)) * squared;
    }
  }
  return sums.total();
}

/// size  a multiple of kGroup
template <class S>
double dot(const S* a, const S* b, std::size_t size) {
  LaneSums sums;
  for (std::size_t k = 0; k < size; k += kernels::kGroup) {
    for (std::size_t lane = 0; lane < kernels::kGroup; ++lane) {
      sums.lanes[lane] += static_cast<double>(a[k + lane]) * static_cast<double>(b[k + lane]);
    }
  }
  return sums.total();
}

}  // namespace tetskin::elastic_detail
