// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What bodies come to rest on in the table of gaps, and how far a point is from it: by formulas of their own, which
// know nothing of how contacts are found.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "scenes/world.h"

namespace tetskin::gaps {

/// Fixed, in several pieces where a body would roll off one; its highest point is at y = 0.
struct GapObstacle {
  std::string name;
  std::string about;
  std::function<void(scenes::World&)> addTo;
  /// World lengths; below 0 within. Exact where a body lies.
  std::function<double(const Eigen::Vector3d&)> distance;
  bool roundOnly = false;  ///< so small that others fall off
};

const std::vector<GapObstacle>& gapObstacles();
/// Throws InputError with all names if there is none.
const GapObstacle& obstacleNamed(const std::string& name);

}  // namespace tetskin::gaps
