// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/impulse_history.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;
using kernels::kWideVector;

/// Most by which one step may be longer or shorter than the one before.
constexpr double kMostGrowth = 2.5;
/// The change of dt^2 K y over the size of y, both with respect to the masses, up to which steps resolve the motion: of
/// a vibration by w radians per step it is w^3. With 2, undamped bars that are bent far gain energy without bound; with
/// 0.3, those that are twisted far gain some. And the number of such steps after which steps are of second order.
constexpr double kMostChange = 0.1;
constexpr int kResolved = 4;

}  // namespace

template <class S>
bool ImpulseHistory<S>::fits(double seconds) const {
  return resolved_ >= kResolved && seconds < kMostGrowth * seconds_ && seconds * kMostGrowth > seconds_;
}

template <class S>
void ImpulseHistory<S>::turn(const std::vector<std::array<double, 9>>& turns,
                             const std::vector<std::uint32_t>& partOf) {
  assert(mean_.size() == 3 * partOf.size() && last_.size() == mean_.size());
  turnWide(mean_.data(), turns, partOf);
  turnWide(last_.data(), turns, partOf);
}

template <class S>
void turnWide(S* wide, const std::vector<std::array<double, 9>>& turns, const std::vector<std::uint32_t>& partOf) {
  std::vector<std::array<S, 9>> factors(turns.size());
  for (std::size_t part = 0; part < turns.size(); ++part) {
    for (std::size_t k = 0; k < 9; ++k) factors[part][k] = static_cast<S>(turns[part][k]);
  }
  const bool several = turns.size() > 1;
  for (std::size_t chunk = 0; chunk < partOf.size() / kGroup; ++chunk) {
    S* first = wide + kWideVector * chunk;
    for (std::size_t lane = 0; lane < kGroup; ++lane) {
      const std::array<S, 9>& turn = factors[several ? partOf[kGroup * chunk + lane] : 0];
      const S x = first[lane], y = first[kGroup + lane], z = first[2 * kGroup + lane];
      first[lane] = turn[0] * x + turn[1] * y + turn[2] * z;
      first[kGroup + lane] = turn[3] * x + turn[4] * y + turn[5] * z;
      first[2 * kGroup + lane] = turn[6] * x + turn[7] * y + turn[8] * z;
    }
  }
}

template <class S>
void ImpulseHistory<S>::addTo(AlignedVector<S>& rightSide, const TimeScheme& scheme, double seconds) {
  assert(fits(seconds) && rightSide.size() == mean_.size());
  const auto factor = static_cast<S>(scheme.filter * seconds / seconds_);
  for (std::size_t k = 0; k < mean_.size(); ++k) {
    mean_[k] *= factor;
    rightSide[k] += mean_[k];
  }
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
  last_.resize(mean_.size(), S(0));
  const auto scale = static_cast<S>(length * length / scheme.alpha(length));
  const auto share = static_cast<S>((1.0 - scheme.filter) * (1.0 - scheme.damping / length));
  const S* solution = matrix.solution();
  S changes[kGroup] = {}, sizes[kGroup] = {};
  for (std::size_t chunk = 0; chunk < matrix.slotCount() / kGroup; ++chunk) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t first = kWideVector * chunk + kGroup * k;
      for (std::size_t lane = 0; lane < kGroup; ++lane) {
        const S mass = matrix.massAt(kGroup * chunk + lane), y = solution[first + lane];
        const S now = mass != S(0) ? scale * (impulses[first + lane] - mass * y) : S(0);
        const S change = now - last_[first + lane];
        changes[lane] += mass != S(0) ? change * change / mass : S(0);
        sizes[lane] += mass * y * y;
        mean_[first + lane] += share * now;
        last_[first + lane] = now;
      }
    }
  }
  const S changed = std::accumulate(changes, changes + kGroup, S(0)),
          size = std::accumulate(sizes, sizes + kGroup, S(0));
  const bool resolves = isKnown() && changed <= static_cast<S>(kMostChange * kMostChange) * size;
  resolved_ = resolves ? std::min(resolved_ + 1, kResolved) : 0;
  seconds_ = seconds;
}

template <class S>
void ImpulseHistory<S>::serialize(StateStream& stream, const BlockMatrix<S>& matrix) {
  stream(seconds_);
  stream(resolved_);
  for (AlignedVector<S>* v : {&mean_, &last_}) {
    if (stream.restoring()) v->resize(matrix.wideSize());
    assert(v->size() == matrix.wideSize());
    matrix.serializeWide(stream, v->data());
  }
}

#define TETSKIN_INSTANTIATE(Scalar)                                                     \
  template class ImpulseHistory<Scalar>;                                                \
  template void turnWide(Scalar* wide, /* NOLINT(bugprone-macro-parentheses): a type */ \
                         const std::vector<std::array<double, 9>>& turns, const std::vector<std::uint32_t>& partOf);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
