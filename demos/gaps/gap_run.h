// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "gaps/gap_bodies.h"
#include "gaps/gap_obstacles.h"

namespace tetskin::gaps {

/// How a body lies at the end of a run.
struct Rest {
  double gap = 0.0;    ///< least gap of the surface's vertices, over the body's size: the value farthest from 0 in the
                       ///< last half second
  double speed = 0.0;  ///< root mean square of the nodes' speeds in that time, in body lengths per second
  bool finite = true;

  bool touches() const;  ///< true if it has not fallen off
  bool still() const;
};

/// Runs a body for this many seconds, starting from just above the obstacle.
Rest restOn(const GapObstacle& obstacle, const GapBody& body, scenes::Contact contact, double seconds);

/// The least gap over all substeps, over the body's size, of a body that hits the obstacle at this many body lengths
/// per second.
double deepestAt(double speed, const GapObstacle& obstacle, const GapBody& body, scenes::Contact contact);

}  // namespace tetskin::gaps
