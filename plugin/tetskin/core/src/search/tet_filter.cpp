// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/kernels/kernel_tables.h>
#include <tetskin/core/src/search/tet_filter.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Bound of the error of n . x + c computed in float for |x_k| <= 1, over the sum of the absolute values of n and c:
/// the coordinates, n and c are rounded once each, as are three products and three sums, which makes less than 8 times
/// 2^-24. The rest is for planes of tets just above kFlatTet, whose own direction is known to some 1e-7 only.
constexpr double kFloatError = 0x1p-19;
/// The same bound for the decision in double: its fourth weight is 1 minus the others, so it has the rounding errors of
/// the largest.
constexpr double kDoubleError = 0x1p-48;
/// Planes with larger coefficients could overflow a float; the filter then passes all points.
constexpr double kMaxCoefficient = 1e30;

}  // namespace

TetFilter TetFilter::ofWeights(const BarycentricMap& map, const SpatialHash::Frame& frame) {
  return TetFilter(map, frame, Eigen::Vector4d::Ones());
}

TetFilter TetFilter::ofDistance(const BarycentricMap& map, const SpatialHash::Frame& frame) {
  // A weight over the length of its gradient is the distance to the face's plane, and no face is nearer than its plane.
  return TetFilter(map, frame, map.gradientLengths() / frame.scale);
}

TetFilter::TetFilter(const BarycentricMap& map, const SpatialHash::Frame& frame, const Eigen::Vector4d& lengths) {
  assert(frame.scale > 0.0);
  // Weight i at a point of the frame is n[i] . point + c[i].
  double n[4][3], c[4], size[4];
  const double unit = 1.0 / frame.scale;
  const Eigen::Vector3d& p = frame.centre;
  map.weightsAt(p.x(), p.y(), p.z(), c[0], c[1], c[2], c[3]);
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) n[i][k] = unit * map.rows[i][k];
    n[3][k] = -(n[0][k] + n[1][k] + n[2][k]);
  }
  for (int i = 0; i < 4; ++i) size[i] = std::abs(n[i][0]) + std::abs(n[i][1]) + std::abs(n[i][2]) + std::abs(c[i]);
  const double sum = size[0] + size[1] + size[2] + size[3];
  const bool usable = sum < kMaxCoefficient;
  for (int i = 0; i < 4; ++i) {
    const double inverse = usable ? 1.0 / lengths[i] : 0.0;
    for (int k = 0; k < 3; ++k) planes_.normal[i][k] = static_cast<float>(n[i][k] * inverse);
    planes_.constant[i] =
        usable ? static_cast<float>((c[i] + kFloatError * size[i] + kDoubleError * sum) * inverse) : 1.0f;
  }
}

std::size_t TetFilter::select(const SpatialHash& hash, const std::vector<SpatialHash::Range>& ranges,
                              const float* limits, std::vector<std::uint32_t>& passed) const {
  assert(std::all_of(ranges.begin(), ranges.end(), [&](const auto& r) { return r.last <= hash.size(); }));
  std::size_t maximum = kernels::kMaxLanes;
  for (const SpatialHash::Range& range : ranges) maximum += range.last - range.first;
  if (passed.size() < maximum) passed.resize(2 * maximum);
  kernels::FilterWork work = planes_;
  work.ranges = ranges.data();
  work.rangeCount = ranges.size();
  work.points[0] = hash.x();
  work.points[1] = hash.y();
  work.points[2] = hash.z();
  work.limits = limits;
  return kernels::selectInUse()(work, passed.data());
}

}  // namespace tetskin
