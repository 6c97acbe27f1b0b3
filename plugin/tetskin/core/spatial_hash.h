// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// A hashed grid of points: which points may lie in a box? Built once by a counting sort, as in the tutorial; its
/// memory is proportional to the points, however far apart they are.
///
/// Neighbouring cells along x are neighbours in the table, so a row of cells is one contiguous range of entries: a
/// query reads a few long ranges instead of many short ones. An *entry* is a point in table order.
///
/// Example: 4 points and a cell size of 1 make a table of 16 cells; the box [0.2, 2.5] x [0, 0] x [0, 0] is one row of
/// the cells 0, 1 and 2 and hence one range of entries (two, if the row wraps round the table's end).
class SpatialHash {
 public:
  /// points     finite, any number
  /// cellSize   edge of a cell, in the points' unit, above 0
  /// tableSize  cells of the table, rounded up to a power of two; 0 chooses about four cells a point: row queries read
  ///            whole ranges, and a sparser table has fewer strangers in them
  SpatialHash(const std::vector<Eigen::Vector3d>& points, double cellSize, std::size_t tableSize = 0);

  std::size_t size() const { return ids_.size(); }
  double cellSize() const { return cellSize_; }
  std::size_t tableSize() const { return cellStart_.size() - 1; }

  /// By entry: index of the point, and its coordinates.
  const std::uint32_t* ids() const { return ids_.data(); }
  const double* x() const { return x_.data(); }
  const double* y() const { return y_.data(); }
  const double* z() const { return z_.data(); }

  /// Calls visit(first, last) for ranges of entries that together hold every point in the box, and others: those in the
  /// same cells, and those whose cells collide. An entry may come up twice where rows collide. Never visits more than
  /// about all entries once a row; falls back to one range of all entries where the box has more rows than there are
  /// points.
  template <class Visit>
  void query(const Box3& box, Visit&& visit) const;

 private:
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
  Cell cellOf(const Eigen::Vector3d& p) const;
  std::size_t rowOf(std::int64_t y, std::int64_t z) const;

  double cellSize_;
  double inverseCellSize_;
  std::size_t mask_;                      ///< table size - 1
  std::vector<std::uint32_t> cellStart_;  ///< table size + 1: first entry of each cell
  std::vector<std::uint32_t> ids_;
  std::vector<double> x_, y_, z_;
};

inline std::size_t SpatialHash::rowOf(std::int64_t y, std::int64_t z) const {
  // Two large odd constants (the 64-bit golden ratio and the multiplier of MMIX's generator) spread neighbouring rows;
  // the high half of the product is the well-mixed one.
  const std::uint64_t h =
      static_cast<std::uint64_t>(y) * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(z) * 6364136223846793005u;
  return static_cast<std::size_t>((h ^ (h >> 29)) * 0xBF58476D1CE4E5B9u >> 32);
}

inline SpatialHash::Cell SpatialHash::cellOf(const Eigen::Vector3d& p) const {
  // Far beyond any sensible grid, but its square and its sums still fit 64 bits. Clamping keeps the order of cells, so
  // a box still covers the cells of the points in it.
  constexpr double kFarthest = 1e15;
  Cell cell;
  for (int k = 0; k < 3; ++k) {
    const double c = std::min(std::max(p[k] * inverseCellSize_, -kFarthest), kFarthest);
    const auto truncated = static_cast<std::int64_t>(c);
    cell[k] = truncated - (c < static_cast<double>(truncated));
  }
  return cell;
}

template <class Visit>
void SpatialHash::query(const Box3& box, Visit&& visit) const {
  const std::uint32_t all = cellStart_.back();
  if (box.isEmpty() || all == 0) return;
  const Cell lo = cellOf(box.min()), hi = cellOf(box.max());
  const double rows = static_cast<double>(hi.y() - lo.y() + 1) * static_cast<double>(hi.z() - lo.z() + 1);
  const std::uint64_t length = static_cast<std::uint64_t>(hi.x() - lo.x()) + 1;
  if (length > mask_ || rows > static_cast<double>(all)) {
    visit(std::uint32_t{0}, all);
    return;
  }
  for (std::int64_t z = lo.z(); z <= hi.z(); ++z) {
    for (std::int64_t y = lo.y(); y <= hi.y(); ++y) {
      const std::size_t first = (rowOf(y, z) + static_cast<std::size_t>(lo.x())) & mask_;
      const std::size_t last = first + length;  // one past
      if (last <= mask_ + 1) {
        if (cellStart_[first] != cellStart_[last]) visit(cellStart_[first], cellStart_[last]);
      } else {
        if (cellStart_[first] != all) visit(cellStart_[first], all);
        const std::uint32_t wrapped = cellStart_[last & mask_];
        if (wrapped != 0) visit(std::uint32_t{0}, wrapped);
      }
    }
  }
}

}  // namespace tetskin
