// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a body's step of second order takes from the steps before: H of time_scheme.h, and whether steps of this length
// resolve its motion. A deformed body may be stiffer than its matrix says; a step of second order then lets vibrations
// grow that are too fast for it, and that one of first order takes away. They show as a change of dt^2 K y from step to
// step, y being the deviation from rigid motion, that is not small beside y itself.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/elastic/src/dynamics/time_scheme.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <array>
#include <vector>

namespace tetskin::elastic_detail {

/// Turns a vector in the wide layout.
/// turns   by component, stored by rows; one alone: of all components;  partOf  by slot: its component
template <class S>
void turnWide(S* wide, const std::vector<std::array<double, 9>>& turns, const std::vector<std::uint32_t>& partOf);

template <class S>
class ImpulseHistory {
 public:
  bool isKnown() const { return seconds_ > 0.0; }
  /// True if the next step may be of second order: the last one is known, about as long, and steps have resolved
  /// the motion for a while.
  bool fits(double seconds) const;
  void forget() {
    seconds_ = 0.0;
    resolved_ = 0;
  }

  /// Turns what is known like its components, as the velocities that belong to it.
  /// turns   by component: rotations, stored by rows;  partOf  by slot: its component
  void turn(const std::vector<std::array<double, 9>>& turns, const std::vector<std::uint32_t>& partOf);
  /// Adds a H to a right side in the wide layout. It grows with the time for which forces act.
  void addTo(AlignedVector<S>& rightSide, const TimeScheme& scheme, double seconds);
  /// Takes away what `addTo` has added.
  void takeFrom(AlignedVector<S>& rightSide) const;
  /// H becomes 0.
  void clear(std::size_t wideSize) { mean_.assign(wideSize, S(0)); }
  /// Call it when a step has been solved, after `addTo` or `clear`.
  /// impulses  A times the solution, in the wide layout; the matrix has the solution
  /// length    of the step;  seconds  for which forces have acted
  void keep(const BlockMatrix<S>& matrix, const AlignedVector<S>& impulses, const TimeScheme& scheme, double length,
            double seconds);

  /// Writes or reads what is known.
  void serialize(StateStream& stream, const BlockMatrix<S>& matrix);

 private:
  AlignedVector<S> mean_;  ///< H, in the wide layout
  AlignedVector<S> last_;  ///< dt^2 K y of the last step, in the wide layout
  double seconds_ = 0.0;   ///< for which forces acted in the last step; 0: it is not known
  int resolved_ = 0;       ///< number of steps that have resolved the motion
};

}  // namespace tetskin::elastic_detail
