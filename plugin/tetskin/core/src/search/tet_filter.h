// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: a quick test in float that drops most points that cannot belong to a tet, and none that can.
// The remaining points are decided in double.
#pragma once

#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/kernels/search_kernels.h>
#include <tetskin/core/src/search/spatial_hash.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin {

/// The planes of a tet's four faces in a hash's frame, each moved slightly outwards.
class TetFilter {
 public:
  /// A filter whose bound is not below the point's smallest weight in the tet, as `map` computes it.
  static TetFilter ofWeights(const BarycentricMap& map, const SpatialHash::Frame& frame);
  /// A filter whose bound, negated, is not above the point's distance to the tet, in the frame's unit.
  static TetFilter ofDistance(const BarycentricMap& map, const SpatialHash::Frame& frame);

  /// Writes those entries in the ranges whose bound is not below -limits[entry], or not below 0 without limits. Returns
  /// how many; `passed` only ever grows.
  std::size_t select(const SpatialHash& hash, const std::vector<SpatialHash::Range>& ranges, const float* limits,
                     std::vector<std::uint32_t>& passed) const;

 private:
  /// Distances are weights over these gradient lengths.
  TetFilter(const BarycentricMap& map, const SpatialHash::Frame& frame, const Eigen::Vector4d& lengths);

  /// The planes only: the bound of plane i at a point of the frame is normal . point + constant.
  kernels::FilterWork planes_;
};

}  // namespace tetskin
