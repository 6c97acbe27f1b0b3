// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/impulse_history.h>

#include <cassert>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;
using kernels::kWideVector;

/// Most by which one step may be longer or shorter than the one before.
constexpr double kMostGrowth = 2.5;

}  // namespace

template <class S>
bool ImpulseHistory<S>::fits(double seconds) const {
  return seconds_ > 0.0 && seconds < kMostGrowth * seconds_ && seconds * kMostGrowth > seconds_;
}

template <class S>
void ImpulseHistory<S>::addTo(AlignedVector<S>& rightSide, const TimeScheme& scheme, double seconds,
                              const std::vector<std::array<double, 9>>& turns,
                              const std::vector<std::uint32_t>& partOf) {
  assert(fits(seconds) && rightSide.size() == mean_.size() && mean_.size() == 3 * partOf.size());
  std::vector<std::array<S, 9>> factors;
  for (const std::array<double, 9>& turn : turns) {
    std::array<S, 9>& factor = factors.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) factor[k] = static_cast<S>(scheme.filter * seconds / seconds_ * turn[k]);
  }
  const bool several = factors.size() > 1;
  for (std::size_t chunk = 0; chunk < partOf.size() / kGroup; ++chunk) {
    S* mean = &mean_[kWideVector * chunk];
    for (std::size_t lane = 0; lane < kGroup; ++lane) {
      const std::array<S, 9>& factor = factors[several ? partOf[kGroup * chunk + lane] : 0];
      const S x = mean[lane], y = mean[kGroup + lane], z = mean[2 * kGroup + lane];
      mean[lane] = factor[0] * x + factor[1] * y + factor[2] * z;
      mean[kGroup + lane] = factor[3] * x + factor[4] * y + factor[5] * z;
      mean[2 * kGroup + lane] = factor[6] * x + factor[7] * y + factor[8] * z;
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
                             double length, double seconds) {
  assert(mean_.size() == matrix.wideSize() && impulses.size() == mean_.size());
  const auto share = static_cast<S>((1.0 - scheme.filter) * length * (length - scheme.damping) / scheme.alpha(length));
  const S* solution = matrix.solution();
  for (std::size_t chunk = 0; chunk < matrix.slotCount() / kGroup; ++chunk) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t first = kWideVector * chunk + kGroup * k;
      for (std::size_t lane = 0; lane < kGroup; ++lane) {
        const S mass = matrix.massAt(kGroup * chunk + lane);
        const S kept = mean_[first + lane] + share * (impulses[first + lane] - mass * solution[first + lane]);
        mean_[first + lane] = mass != S(0) ? kept : S(0);
      }
    }
  }
  seconds_ = seconds;
}

#define TETSKIN_INSTANTIATE(Scalar) template class ImpulseHistory<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
