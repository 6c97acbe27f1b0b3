// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/point_reader.h>
#include <tetskin/core/src/kernels/search_kernels.h>
#include <tetskin/core/types.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

namespace tetskin {

/// A grid of the points in a box: which of them may lie in a smaller box? Built once by a counting sort, as in the
/// tutorial. The tutorial's hash scatters neighbouring cells over the table; here the table is a block of cells that
/// repeats through space, so that neighbours stay neighbours in memory. A row of cells along x is one contiguous range
/// of entries, and a mesh of millions of vertices, whose order mostly follows space, is read and written almost
/// sequentially. If all cells fit the table, no two share a place; otherwise the table's edges are halved, the longest
/// first, until it is small enough, and cells that are whole tables apart share a place. So memory is proportional to
/// the number of points, however far apart they are. An *entry* is a point in table order.
///
/// Example: 4 points in the box [0, 4] x [0, 1] x [0, 1] and a cell size of 1 make a table of 5 x 2 x 2 cells, folded
/// to 3 x 2 x 2; the box [0.2, 1.5] x [0, 0] x [0, 0] is the one row of cells 0 and 1 and hence one range of entries.
class SpatialHash {
 public:
  /// The frame of the entries' float coordinates: (p - centre) * scale is within [-1, 1] in the box.
  struct Frame {
    Eigen::Vector3d centre;
    double scale;
  };
  using Range = kernels::EntryRange;
  /// Entry coordinates are followed by this many zeros, so that kernels may read whole blocks.
  static constexpr std::size_t kPadding = kernels::kMaxLanes;

  /// points     finite, any number
  /// box        points outside of it are left out
  /// cellSize   edge of a cell, in the points' unit, above 0
  /// first      by point; those that are not their own first are left out, see `weldCoincident`; empty: all are
  ///            included
  /// tableSize  most cells of the table; 0: kCellsPerPoint per point, or kMinCells if that is more
  SpatialHash(PointReader points, const Box3& box, double cellSize, const std::vector<std::uint32_t>& first = {},
              std::size_t tableSize = 0);

  std::size_t size() const { return ids_.size(); }
  std::size_t tableSize() const { return cellStart_.size() - 1; }
  const Frame& frame() const { return frame_; }

  /// By entry: index of the point, and its coordinates in the frame, correctly rounded except for a double's last bits.
  const std::uint32_t* ids() const { return ids_.data(); }
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* z() const { return z_.data(); }

  /// Calls visit(first, last) for disjoint ranges of entries that together contain every point of the hash in the box,
  /// and others: those in the same cells, and those whose cells share a place with them.
  template <class Visit>
  void query(const Box3& box, Visit&& visit) const;
  /// Writes these ranges; returns how many entries they have.
  std::size_t findRanges(const Box3& box, std::vector<Range>& ranges) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  /// A range of cells along one edge of the table: `count` cells from `first`, wrapping around at its end.
  struct Span {
    std::uint32_t first;
    std::uint32_t count;
  };
  /// Cells of a table per point, so that most hold one point or none; and the smallest number of cells.
  static constexpr std::size_t kCellsPerPoint = 4, kMinCells = 4096;

  void chooseTable(std::size_t maxCells);
  void placePoints(PointReader points, const std::vector<std::uint32_t>& first);
  void copyCoordinates(PointReader points);
  Cell cellOf(const Eigen::Vector3d& p) const;
  std::uint32_t wrapped(std::int64_t cell, int axis) const;
  Span spanOf(std::int64_t lo, std::int64_t hi, int axis) const;
  template <class Visit>
  void visitRow(std::size_t row, const Span& span, Visit&& visit) const;

  Box3 box_;
  Frame frame_;
  double inverseCellSize_;
  std::array<std::uint32_t, 3> table_{1, 1, 1};  ///< cells along each edge of the table
  std::vector<std::uint32_t> cellStart_;         ///< table size + 1: first entry of each cell
  std::vector<std::uint32_t> ids_;
  std::vector<float> x_, y_, z_;
};

inline SpatialHash::Cell SpatialHash::cellOf(const Eigen::Vector3d& p) const {
  // Far beyond any sensible grid, but within 64 bits. Every step keeps the order of points, so a box covers the cells
  // of the points in it.
  constexpr double kMaxCell = 1e15;
  Cell cell;
  for (int k = 0; k < 3; ++k) {
    cell[static_cast<std::size_t>(k)] =
        static_cast<std::int64_t>(std::min((p[k] - box_.min()[k]) * inverseCellSize_, kMaxCell));
  }
  return cell;
}

inline std::uint32_t SpatialHash::wrapped(std::int64_t cell, int axis) const {
  const std::int64_t size = table_[static_cast<std::size_t>(axis)];
  return static_cast<std::uint32_t>(cell < size ? cell : cell % size);
}

inline SpatialHash::Span SpatialHash::spanOf(std::int64_t lo, std::int64_t hi, int axis) const {
  assert(lo >= 0 && lo <= hi);
  const std::uint32_t size = table_[static_cast<std::size_t>(axis)];
  if (hi - lo + 1 >= static_cast<std::int64_t>(size)) return {0, size};
  return {wrapped(lo, axis), static_cast<std::uint32_t>(hi - lo + 1)};
}

template <class Visit>
void SpatialHash::visitRow(std::size_t row, const Span& span, Visit&& visit) const {
  const auto range = [&](std::size_t first, std::size_t last) {
    const std::uint32_t begin = cellStart_[row + first], end = cellStart_[row + last];
    if (begin != end) visit(begin, end);
  };
  const std::size_t last = std::size_t{span.first} + span.count;
  range(span.first, std::min<std::size_t>(last, table_[0]));
  if (last > table_[0]) range(0, last - table_[0]);
}

template <class Visit>
void SpatialHash::query(const Box3& box, Visit&& visit) const {
  const Box3 inner = box.intersection(box_);
  if (inner.isEmpty()) return;
  const Cell lo = cellOf(inner.min()), hi = cellOf(inner.max());
  const Span x = spanOf(lo[0], hi[0], 0), y = spanOf(lo[1], hi[1], 1), z = spanOf(lo[2], hi[2], 2);
  for (std::uint32_t k = 0; k < z.count; ++k) {
    const std::uint32_t atZ = z.first + k < table_[2] ? z.first + k : z.first + k - table_[2];
    for (std::uint32_t j = 0; j < y.count; ++j) {
      const std::uint32_t atY = y.first + j < table_[1] ? y.first + j : y.first + j - table_[1];
      visitRow((std::size_t{atZ} * table_[1] + atY) * table_[0], x, visit);
    }
  }
}

}  // namespace tetskin
