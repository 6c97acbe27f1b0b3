// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a body's step of second order takes from the steps before: H of time_scheme.h.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/elastic/src/dynamics/time_scheme.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <array>
#include <vector>

namespace tetskin::elastic_detail {

template <class S>
class ImpulseHistory {
 public:
  bool isKnown() const { return seconds_ > 0.0; }
  /// True if it is known, and the next step is about as long as the last.
  bool fits(double seconds) const;
  void forget() { seconds_ = 0.0; }

  /// Adds a H to a right side in the wide layout. H is turned like its components, as the velocities are that belong to
  /// it, and grows with the time for which forces act.
  /// turns   by component: rotations, stored by rows;  partOf  by slot: its component
  void addTo(AlignedVector<S>& rightSide, const TimeScheme& scheme, double seconds,
             const std::vector<std::array<double, 9>>& turns, const std::vector<std::uint32_t>& partOf);
  /// Takes away what `addTo` has added.
  void takeFrom(AlignedVector<S>& rightSide) const;
  /// H becomes 0.
  void clear(std::size_t wideSize) { mean_.assign(wideSize, S(0)); }
  /// Call it when a step has been solved, after `addTo` or `clear`.
  /// impulses  A times the solution, in the wide layout; the matrix has the solution
  /// length    of the step;  seconds  for which forces have acted
  void keep(const BlockMatrix<S>& matrix, const AlignedVector<S>& impulses, const TimeScheme& scheme, double length,
            double seconds);

 private:
  AlignedVector<S> mean_;  ///< H, in the wide layout
  double seconds_ = 0.0;   ///< for which forces acted in the last step; 0: H is not known
};

}  // namespace tetskin::elastic_detail
