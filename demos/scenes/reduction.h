// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/elastic/vibration_modes.h>

#include <deque>
#include <functional>
#include <vector>

namespace tetskin::scenes {

/// The fine tets whose vibrations move the bodies of a scene, instead of elastic forces.
class Reduction {
 public:
  /// fine  where the bodies' cage is; with fill, factors and masses, if it has them
  /// most  modes that any body takes
  Reduction(Cage fine, int most) : fine_(std::move(fine)), most_(most) {}

  /// The modes of the fine tets, free or with the nodes held that a scene chooses: found when they are first asked for.
  /// Throws InputError.
  const VibrationModes& modes(const std::function<bool(const Eigen::Vector3d&)>& held);
  /// Of the processor, that finding the last ones took.
  double milliseconds() const { return milliseconds_; }

  std::vector<int> nodeTets;  ///< see ReducedBodyOptions

 private:
  Cage fine_;
  int most_;
  std::deque<VibrationModes> found_;
  double milliseconds_ = 0.0;
};

}  // namespace tetskin::scenes
