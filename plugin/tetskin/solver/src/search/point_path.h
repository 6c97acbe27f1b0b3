// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: what a surface point comes near to on its path in a step.
#pragma once

#include <tetskin/solver/src/search/shape_probe.h>

namespace tetskin::bullet_detail {

/// A point's distance from a shape at a position on its straight path.
struct PathState {
  ShapeDistance distance;  ///< at that position; BT_LARGE_FLOAT if nothing is near
  btVector3 where;
  btScalar clear = 0;  ///< distance beyond the reach at the beginning of the path, if nothing is near
};

/// The height of a point above the plane of a state; the plane touches the shape.
inline btScalar heightAbove(const PathState& plane, const btVector3& point) {
  return plane.distance.distance + plane.distance.normal.dot(point - plane.where);
}

/// Where the path first comes within reach of the shape: it may pass through a thin shape in one step.
PathState firstInReach(const ShapeProbe& probe, const NodePath& path, btScalar reach);

/// The state whose plane decides for a point that comes within reach. Moving along a seam, past an edge, or below the
/// edge of something that slides on it, a point first comes near to the edge from the side; a plane there would stop
/// it, although nothing is in its way. Unless the path leads inside, the nearest point of the path decides instead: the
/// plane there does not block the path, and what was met first is behind it. Nothing decides (the distance is
/// BT_LARGE_FLOAT) for a path that passes at more than the margin and leaves the reach: on a wavy surface, points rise
/// ahead of what slides over them.
/// met  where the path first comes within reach
PathState decidingState(const ShapeProbe& probe, const NodePath& path, btScalar margin, btScalar reach,
                        const PathState& met);

}  // namespace tetskin::bullet_detail
