// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: what a point of the surface comes near to on its path in a step.
#pragma once

#include <tetskin/solver/src/search/shape_probe.h>

namespace tetskin::bullet_detail {

/// A point's distance from a shape at a position on its straight path.
struct PathState {
  ShapeDistance distance;  ///< at that position; BT_LARGE_FLOAT if it comes near to nothing
  btVector3 where;
  btScalar clear = 0;  ///< distance beyond the reach where the path begins, if it comes near to nothing
};

/// The height of a point above the plane of a state, which touches the shape.
inline btScalar heightAbove(const PathState& plane, const btVector3& point) {
  return plane.distance.distance + plane.distance.normal.dot(point - plane.where);
}

/// Where the path first comes within reach of the shape: it may pass through a thin shape in one step.
PathState firstInReach(const ShapeProbe& probe, const NodePath& path, btScalar reach);

/// The state whose plane decides for a point that comes within reach. On its way along a seam, past an edge, or below
/// the edge of what slides on it, a point first comes near to the edge, from aside: a plane there would stop it,
/// although nothing is in its way. Unless the path leads inside, its nearest point decides: the plane there is not in
/// the way, and has behind it what was met first. Nothing decides, and the distance is BT_LARGE_FLOAT, for a path that
/// goes by at more than the margin and leaves the reach: on a wavy surface, points rise ahead of what slides over them.
/// met  where the path first comes within reach
PathState decidingState(const ShapeProbe& probe, const NodePath& path, btScalar margin, btScalar reach,
                        const PathState& met);

}  // namespace tetskin::bullet_detail
