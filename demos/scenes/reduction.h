// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/elastic/vibration_modes.h>

#include <deque>
#include <functional>
#include <vector>

namespace tetskin::scenes {

/// The fine tets whose modes move the bodies of a scene, instead of elastic forces.
class Reduction {
 public:
  /// fine     where the bodies' cage is; with volume fractions, stiffness factors and masses, if it has them
  /// maximum  the largest number of modes that any body uses
  Reduction(Cage fine, int maximum) : fine_(std::move(fine)), max_(maximum) {}

  /// The modes of the fine tets, free or with the pinned nodes that a scene chooses. They are computed when they are
  /// first asked for. Throws InputError.
  const VibrationModes& modes(const std::function<bool(const Eigen::Vector3d&)>& pinned);
  /// Processor time of the last computation of modes.
  double milliseconds() const { return milliseconds_; }

  std::vector<int> nodeTets;  ///< see ReducedBodyOptions

 private:
  Cage fine_;
  int max_;
  std::deque<VibrationModes> found_;
  double milliseconds_ = 0.0;
};

}  // namespace tetskin::scenes
