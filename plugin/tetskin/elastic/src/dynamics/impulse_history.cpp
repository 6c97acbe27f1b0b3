// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/impulse_history.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// Share of a body's size up to which a node counts as where it was: far more than rounding, and far less than one
/// sees.
constexpr double kNear = 1e-4;
/// Most by which one step may be longer or shorter than the one before.
constexpr double kMostGrowth = 2.5;

}  // namespace

template <class S>
bool ImpulseHistory<S>::fits(double seconds) const {
  return seconds_ > 0.0 && seconds < kMostGrowth * seconds_ && seconds * kMostGrowth > seconds_;
}

template <class S>
bool ImpulseHistory<S>::continues(std::size_t slot, const S* point, const S* velocity) const {
  assert(4 * slot < points_.size());
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::abs(point[k] - points_[4 * slot + k]) <= near_)) return false;
    if (!(length_ * std::abs(velocity[k] - speeds_[4 * slot + k]) <= near_)) return false;
  }
  return true;
}

template <class S>
void ImpulseHistory<S>::addTo(AlignedVector<S>& rightSide, const TimeScheme& scheme, double seconds,
                              const std::vector<std::array<double, 9>>& turns, const std::vector<std::uint32_t>& partOf) {
  assert(fits(seconds) && rightSide.size() == mean_.size());
  std::vector<std::array<S, 9>> factors;
  for (const std::array<double, 9>& turn : turns) {
    std::array<S, 9>& factor = factors.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) factor[k] = static_cast<S>(scheme.filter * seconds / seconds_ * turn[k]);
  }
  for (std::size_t slot = 0; slot < partOf.size(); ++slot) {
    const std::array<S, 9>& factor = factors[partOf[slot]];
    S* mean = &mean_[BlockMatrix<S>::wideOfSlot(slot)];
    const S from[3] = {mean[0], mean[kGroup], mean[2 * kGroup]};
    for (std::size_t k = 0; k < 3; ++k) {
      mean[k * kGroup] = factor[3 * k] * from[0] + factor[3 * k + 1] * from[1] + factor[3 * k + 2] * from[2];
    }
  }
  for (std::size_t k = 0; k < mean_.size(); ++k) rightSide[k] += mean_[k];
}

template <class S>
void ImpulseHistory<S>::takeFrom(AlignedVector<S>& rightSide) const {
  assert(rightSide.size() == mean_.size());
  for (std::size_t k = 0; k < mean_.size(); ++k) rightSide[k] -= mean_[k];
}

template <class S>
void ImpulseHistory<S>::keep(const BlockMatrix<S>& matrix, const AlignedVector<S>& impulses, const TimeScheme& scheme,
                             double seconds, const AlignedVector<S>& points, const AlignedVector<S>& rigid,
                             double length) {
  assert(points.size() == 4 * matrix.slotCount() && rigid.size() == points.size());
  assert(mean_.size() == matrix.wideSize());
  points_.resize(points.size());
  speeds_.resize(points.size());
  const S* solution = matrix.solution();
  const auto dt = static_cast<S>(length);
  const auto share = static_cast<S>((1.0 - scheme.filter) * (length - scheme.damping) /
                                    ((1.0 - scheme.filter) * scheme.damping + scheme.filter * length));
  S reach = S(0);
  for (std::size_t slot = 0; slot < matrix.slotCount(); ++slot) {
    const std::size_t wide = BlockMatrix<S>::wideOfSlot(slot);
    const S mass = matrix.massAt(slot);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = wide + k * kGroup;
      mean_[at] = mass != S(0) ? mean_[at] + share * (impulses[at] - mass * solution[at]) : S(0);
      const S velocity = rigid[4 * slot + k] + solution[at];
      speeds_[4 * slot + k] = velocity;
      points_[4 * slot + k] = points[4 * slot + k] + dt * velocity;
      if (mass != S(0)) reach = std::max(reach, std::abs(points[4 * slot + k] - points[k]));
    }
  }
  near_ = static_cast<S>(kNear) * reach;
  length_ = dt;
  seconds_ = seconds;
}

#define TETSKIN_INSTANTIATE(Scalar) template class ImpulseHistory<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
