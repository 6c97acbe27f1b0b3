// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/tet_filter.h>

#include <algorithm>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tetskin {
namespace {

/// Bounds on |n . x + c| computed in float for |x_k| <= 1, over the sum of the absolute values of n and c: the
/// coordinates, n and c are rounded once each, three products and three sums as well, which makes less than 8 times
/// 2^-24. The rest is for planes of tets just above kFlatTet, whose own direction is known to some 1e-7 only.
constexpr double kFloatError = 0x1p-19;
/// The same for what the double decision itself loses: its fourth weight is what the others leave of 1, so it has the
/// rounding errors of the largest.
constexpr double kDoubleError = 0x1p-48;
/// Planes beyond this could overflow a float; the filter then lets everything pass.
constexpr double kLargest = 1e30;
/// Entries tested at a time; as many zeros follow the hash's coordinates at least.
constexpr std::uint32_t kLanes = 4;
static_assert(kLanes <= SpatialHash::kPadding, "whole blocks may be read");

#if defined(__SSE2__)
using Lanes = __m128;
Lanes broadcast(float x) {
  return _mm_set1_ps(x);
}
Lanes load(const float* p) {
  return _mm_loadu_ps(p);
}
Lanes add(Lanes a, Lanes b) {
  return _mm_add_ps(a, b);
}
Lanes multiply(Lanes a, Lanes b) {
  return _mm_mul_ps(a, b);
}
Lanes smaller(Lanes a, Lanes b) {
  return _mm_min_ps(a, b);
}
/// A bit a lane: is it not below 0?
unsigned notNegative(Lanes a) {
  return ~static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a, _mm_setzero_ps()))) & 15u;
}
#else
using Lanes = Eigen::Array4f;
Lanes broadcast(float x) {
  return Lanes::Constant(x);
}
Lanes load(const float* p) {
  return Eigen::Map<const Lanes>(p);
}
Lanes add(const Lanes& a, const Lanes& b) {
  return a + b;
}
Lanes multiply(const Lanes& a, const Lanes& b) {
  return a * b;
}
Lanes smaller(const Lanes& a, const Lanes& b) {
  return a.min(b);
}
unsigned notNegative(const Lanes& a) {
  unsigned bits = 0;
  for (int k = 0; k < 4; ++k) bits |= a[k] < 0.0f ? 0u : 1u << k;
  return bits;
}
#endif

struct Plane {
  Lanes x, y, z, constant;
  Lanes at(Lanes px, Lanes py, Lanes pz) const {
    return add(add(multiply(x, px), multiply(y, py)), add(multiply(z, pz), constant));
  }
};

}  // namespace

TetFilter TetFilter::ofWeights(const BarycentricMap& map, const SpatialHash::Frame& frame) {
  return TetFilter(map, frame, Eigen::Vector4d::Ones());
}

TetFilter TetFilter::ofDistance(const BarycentricMap& map, const SpatialHash::Frame& frame) {
  // A weight over the length of its gradient is the distance to the face's plane, and no face is nearer than its plane.
  return TetFilter(map, frame, map.gradientLengths() / frame.scale);
}

TetFilter::TetFilter(const BarycentricMap& map, const SpatialHash::Frame& frame, const Eigen::Vector4d& lengths) {
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
  const bool usable = sum < kLargest;
  for (int i = 0; i < 4; ++i) {
    const double inverse = usable ? 1.0 / lengths[i] : 0.0;
    for (int k = 0; k < 3; ++k) normal_[i][k] = static_cast<float>(n[i][k] * inverse);
    constant_[i] = usable ? static_cast<float>((c[i] + kFloatError * size[i] + kDoubleError * sum) * inverse) : 1.0f;
  }
}

std::size_t TetFilter::select(const SpatialHash& hash, const std::vector<SpatialHash::Range>& ranges,
                              const float* limits, std::vector<std::uint32_t>& passed) const {
  std::size_t most = kLanes;
  for (const SpatialHash::Range& range : ranges) most += range.last - range.first;
  if (passed.size() < most) passed.resize(2 * most);
  std::uint32_t* out = passed.data();
  Plane planes[4];
  for (int i = 0; i < 4; ++i) {
    planes[i] = {broadcast(normal_[i][0]), broadcast(normal_[i][1]), broadcast(normal_[i][2]), broadcast(constant_[i])};
  }
  for (const SpatialHash::Range& range : ranges) {
    for (std::uint32_t e = range.first; e < range.last; e += kLanes) {
      const Lanes x = load(hash.x() + e), y = load(hash.y() + e), z = load(hash.z() + e);
      Lanes bound = smaller(smaller(planes[0].at(x, y, z), planes[1].at(x, y, z)),
                            smaller(planes[2].at(x, y, z), planes[3].at(x, y, z)));
      if (limits) bound = add(bound, load(limits + e));
      unsigned bits = notNegative(bound);
      if (range.last - e < kLanes) bits &= (1u << (range.last - e)) - 1;
      for (std::uint32_t k = 0; k < kLanes; ++k) {  // without a branch, which would be mispredicted at every hit
        *out = e + k;
        out += bits >> k & 1;
      }
    }
  }
  return static_cast<std::size_t>(out - passed.data());
}

}  // namespace tetskin
