// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/reduction.h"

#include "scenes/input_error.h"
#include "scenes/timer.h"

namespace tetskin::scenes {

const VibrationModes& Reduction::modes(const std::function<bool(const Eigen::Vector3d&)>& pinned) {
  VibrationOptions options;
  options.modeCount = max_;
  options.stiffnessScale = fine_.stiffnessScale();
  options.nodeMasses = fine_.masses;
  for (std::size_t n = 0; n < fine_.mesh.nodeCount(); ++n) {
    if (pinned && pinned(fine_.mesh.nodes[n])) options.pinned.push_back(static_cast<int>(n));
  }
  for (const VibrationModes& one : found_) {
    if (one.pinned == options.pinned) return one;
  }
  const CpuTimer timer;
  Result<VibrationModes> modes = computeVibrationModes(fine_.mesh, options);
  require(modes.status());
  milliseconds_ = timer.milliseconds();
  return found_.emplace_back(std::move(modes).value());
}

}  // namespace tetskin::scenes
