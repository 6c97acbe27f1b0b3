// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How far from an obstacle a body is drawn that lies on it, and how deep a body is drawn in an obstacle that it has
// just hit: with contact at the visual surface, and at the cage's nodes. Lengths are over the body's size, speeds in
// body lengths per second.
#pragma once

#include <string>
#include <vector>

#include "measure/body_model.h"
#include "measure/obstacles.h"
#include "measure/run.h"

namespace tetskin::gaps {

/// A serpent, a ball ("round") or an animal with four legs ("legs"), in world space, centred at the origin; the largest
/// side of the cage's box is kSize.
measure::ModelPtr makeGapBody(const std::string& name, std::size_t tets);

/// In several pieces where a body would roll off one; the highest point is at y = 0. The distance is exact where a body
/// lies.
struct GapObstacle : measure::Obstacle {
  std::string name;
  bool roundOnly = false;  ///< so small that bodies other than the round one fall off
};

const std::vector<GapObstacle>& gapObstacles();

/// Named gap/TETS/OBSTACLE/BODY.
measure::MeasuredScenes gapScenes();

}  // namespace tetskin::gaps
