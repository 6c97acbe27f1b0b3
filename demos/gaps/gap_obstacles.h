// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The obstacles in the table of gaps, and the distance of a point from each: by formulas that are independent of how
// contacts are found.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "scenes/world.h"

namespace tetskin::gaps {

/// Fixed, in several pieces where a body would roll off one; the highest point is at y = 0.
struct GapObstacle {
  std::string name;
  std::string about;
  std::function<void(scenes::World&)> addTo;
  /// World lengths; negative inside. Exact where a body lies.
  std::function<double(const Eigen::Vector3d&)> distance;
  bool roundOnly = false;  ///< so small that bodies other than the round one fall off
};

const std::vector<GapObstacle>& gapObstacles();
/// Throws InputError, with all names, if there is no such obstacle.
const GapObstacle& obstacleNamed(const std::string& name);

}  // namespace tetskin::gaps
