// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is measured of a body on an obstacle. Lengths are over the body's size, speeds in body lengths per second.
#pragma once

#include "gaps/gap_obstacles.h"
#include "measure/body_model.h"
#include "measure/run.h"

namespace tetskin::gaps {

/// Reports how a body lies after this many seconds, starting from just above the obstacle: the gap, unless it has
/// fallen off, which is the least one of the surface's vertices, and the value farthest from 0 in the last half second;
/// and the root mean square of the nodes' speeds in that time.
void rest(measure::Run& run, const GapObstacle& obstacle, const measure::ModelPtr& body, double seconds);

/// Reports the least gap over all steps of a body that hits the obstacle at this speed.
void hit(measure::Run& run, const GapObstacle& obstacle, const measure::ModelPtr& body, double speed);

}  // namespace tetskin::gaps
