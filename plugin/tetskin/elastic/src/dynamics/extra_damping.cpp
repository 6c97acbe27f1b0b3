// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/extra_damping.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {

template <class S>
ExtraDamping<S>::ExtraDamping(const RestTets& rest, const BlockMatrix<S>& matrix)
    : stiffness_(rest, matrix.pattern().slotOf), velocities_(3 * matrix.slotCount()), impulses_(velocities_) {}

template <class S>
void ExtraDamping<S>::takeFrom(AlignedVector<S>& impulses, const S* velocities) {
  assert(impulses.size() == velocities_.size());
  const std::size_t slots = velocities_.size() / 3;
  bySlots(slots, [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) {
      velocities_[3 * slot + k] = static_cast<double>(velocities[wide + k * kernels::kGroup]);
    }
  });
  std::fill(impulses_.begin(), impulses_.end(), 0.0);
  stiffness_.addProduct(velocities_, impulses_);
  bySlots(slots, [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) {
      impulses[wide + k * kernels::kGroup] -= static_cast<S>(impulses_[3 * slot + k]);
    }
  });
}

TETSKIN_INSTANTIATE_CLASS(ExtraDamping)

}  // namespace tetskin::elastic_detail
