// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "gaps/gap_bodies.h"
#include "gaps/gap_obstacles.h"

namespace tetskin::gaps {

/// How a body lies at the end.
struct Rest {
  double gap = 0.0;    ///< least of the surface's vertices, in sizes, the one farthest from 0 in the last half second
  double speed = 0.0;  ///< root mean square of the nodes' then, in sizes a second
  bool finite = true;

  bool touches() const;  ///< it has not fallen off
  bool still() const;
};

/// From just above the obstacle, for so long.
Rest restOn(const GapObstacle& obstacle, const GapBody& body, scenes::Contact contact, double seconds);

/// Least gap of all substeps, in sizes, of a body that hits the obstacle at so many sizes a second.
double deepestAt(double speed, const GapObstacle& obstacle, const GapBody& body, scenes::Contact contact);

}  // namespace tetskin::gaps
