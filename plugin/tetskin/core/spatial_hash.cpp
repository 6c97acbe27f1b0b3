// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "Blazing Fast Neighbor Search with Spatial Hashing", Ten Minute Physics 11, 2022
//   Matthias Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects", VMV 2003
#include <tetskin/core/spatial_hash.h>

#include <limits>

namespace tetskin {

SpatialHash::SpatialHash(const std::vector<Eigen::Vector3d>& points, double cellSize, std::size_t tableSize)
    : cellSize_(cellSize), inverseCellSize_(1.0 / cellSize) {
  assert(cellSize > 0.0 && std::isfinite(inverseCellSize_));
  assert(points.size() < std::numeric_limits<std::uint32_t>::max());
  assert(firstNonFinite(viewOf(points)) == points.size());
  if (tableSize == 0) tableSize = 4 * points.size();
  std::size_t size = 1;
  while (size < tableSize) size *= 2;
  mask_ = size - 1;

  std::vector<std::uint32_t> cellOfPoint(points.size());
  cellStart_.assign(size + 1, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Cell cell = cellOf(points[i]);
    cellOfPoint[i] =
        static_cast<std::uint32_t>((rowOf(cell.y(), cell.z()) + static_cast<std::size_t>(cell.x())) & mask_);
    ++cellStart_[cellOfPoint[i]];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& start : cellStart_) start = sum += start;  // now one past each cell's last entry

  ids_.resize(points.size());
  x_.resize(points.size());
  y_.resize(points.size());
  z_.resize(points.size());
  for (std::size_t i = points.size(); i-- > 0;) {  // from the back, so that entries of a cell keep the points' order
    const std::uint32_t entry = --cellStart_[cellOfPoint[i]];
    ids_[entry] = static_cast<std::uint32_t>(i);
    x_[entry] = points[i].x();
    y_[entry] = points[i].y();
    z_[entry] = points[i].z();
  }
}

}  // namespace tetskin
