// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The obstacles in the table of gaps.
#pragma once

#include <string>
#include <vector>

#include "measure/obstacles.h"

namespace tetskin::gaps {

/// In several pieces where a body would roll off one; the highest point is at y = 0. The distance is exact where a body
/// lies.
struct GapObstacle : measure::Obstacle {
  std::string name;
  bool roundOnly = false;  ///< so small that bodies other than the round one fall off
};

const std::vector<GapObstacle>& gapObstacles();
/// Throws InputError, with all names, if there is no such obstacle.
const GapObstacle& obstacleNamed(const std::string& name);

}  // namespace tetskin::gaps
