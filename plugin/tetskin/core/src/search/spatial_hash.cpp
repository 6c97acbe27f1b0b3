// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "Blazing Fast Neighbor Search with Spatial Hashing", Ten Minute Physics 11, 2022
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/search/spatial_hash.h>

#include <cassert>
#include <limits>

namespace tetskin {
namespace {

constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

SpatialHash::Frame frameOf(const Box3& box) {
  if (box.isEmpty()) return {Eigen::Vector3d::Zero(), 1.0};
  const double half = 0.5 * box.sizes().maxCoeff();
  return {box.center(), half > 0.0 ? 1.0 / half : 1.0};
}

}  // namespace

SpatialHash::SpatialHash(PointReader points, const Box3& box, double cellSize, const std::vector<std::uint32_t>& first,
                         std::size_t tableSize)
    : box_(box), frame_(frameOf(box)), inverseCellSize_(1.0 / cellSize) {
  assert(cellSize > 0.0 && std::isfinite(inverseCellSize_) && std::isfinite(frame_.scale));
  assert(points.size() < kNoCell);
  assert(first.empty() || first.size() == points.size());
  const std::size_t maximum = tableSize > 0 ? tableSize : std::max(kCellsPerPoint * points.size(), kMinCells);
  chooseTable(std::min<std::size_t>(maximum, kNoCell));
  placePoints(points, first);
  copyCoordinates(points);
}

void SpatialHash::chooseTable(std::size_t maxCells) {
  if (box_.isEmpty()) return;
  const Cell last = cellOf(box_.max());
  std::array<double, 3> edges;  // as double: their product may be far beyond any integer
  for (std::size_t k = 0; k < 3; ++k) edges[k] = static_cast<double>(last[k] + 1);
  while (edges[0] * edges[1] * edges[2] > static_cast<double>(maxCells)) {
    double& longest = *std::max_element(edges.begin(), edges.end());
    longest = std::ceil(0.5 * longest);
  }
  for (std::size_t k = 0; k < 3; ++k) table_[k] = static_cast<std::uint32_t>(edges[k]);
  assert(table_[0] > 0 && table_[1] > 0 && table_[2] > 0);
}

void SpatialHash::placePoints(PointReader points, const std::vector<std::uint32_t>& first) {
  const auto cellIndexOf = [&](std::uint32_t i) {
    if (!first.empty() && first[i] != i) return kNoCell;
    const Eigen::Vector3d p = points[i];
    if (!box_.contains(p)) return kNoCell;
    const Cell cell = cellOf(p);
    return (wrapped(cell[2], 2) * table_[1] + wrapped(cell[1], 1)) * table_[0] + wrapped(cell[0], 0);
  };
  std::vector<std::uint32_t> indices(points.size());
  bool known = false;  // from the second time on
  Lists<> cells = packLists(std::size_t{table_[0]} * table_[1] * table_[2], [&](auto&& add) {
    for (std::uint32_t i = 0; i < indices.size(); ++i) {
      if (!known) indices[i] = cellIndexOf(i);
      if (indices[i] != kNoCell) add(indices[i], i);
    }
    known = true;
  });
  cellStart_ = std::move(cells.starts);
  ids_ = std::move(cells.values);
  assert(cellStart_.back() == ids_.size());
}

void SpatialHash::copyCoordinates(PointReader points) {
  for (std::vector<float>* plane : {&x_, &y_, &z_}) plane->resize(ids_.size() + kPadding);
  for (std::size_t e = 0; e < ids_.size(); ++e) {
    const Eigen::Vector3d p = (points[ids_[e]] - frame_.centre) * frame_.scale;
    x_[e] = static_cast<float>(p.x());
    y_[e] = static_cast<float>(p.y());
    z_[e] = static_cast<float>(p.z());
  }
}

std::size_t SpatialHash::findRanges(const Box3& box, std::vector<Range>& ranges) const {
  std::size_t entries = 0;
  ranges.clear();
  query(box, [&](std::uint32_t first, std::uint32_t last) {
    ranges.push_back({first, last});
    entries += last - first;
  });
  return entries;
}

}  // namespace tetskin
