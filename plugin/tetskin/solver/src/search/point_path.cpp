// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   John C. Hart, "Sphere Tracing", The Visual Computer 12, 1996 (steps of the distance along a straight path)
#include <tetskin/solver/src/search/point_path.h>

#include <algorithm>
#include <optional>

namespace tetskin::bullet_detail {
namespace {

/// Most steps along the path of a point. After these, it counts as touching whatever it has come near to.
constexpr int kMaxPathSteps = 24;
/// Distance that counts as touching, as a fraction of the margin, or of the reach.
constexpr btScalar kMet = btScalar(0.05);
/// A point that moves sideways by less than this fraction of its distance keeps its direction to the nearest surface.
constexpr btScalar kSameDirection = btScalar(0.125);
/// Most halvings of a step in the search for the nearest point of the path.
constexpr int kMaxPathHalvings = 4;

/// The nearest point of a path between two of its states: it approaches the shape at the first, and no longer at the
/// second.
/// Returns  a state so close to it that the beginning of the path is above its plane; nothing if the path leads inside
std::optional<PathState> turningState(const ShapeProbe& probe, const NodePath& path, btScalar margin, btScalar reach,
                                      PathState near, PathState far) {
  const btVector3 direction = path.predicted - path.now;
  const auto isFar = [&] { return far.distance.distance >= reach; };
  for (int k = 0; k < kMaxPathHalvings && (isFar() || heightAbove(far, path.now) < margin); ++k) {
    const btVector3 where = (near.where + far.where) * btScalar(0.5);
    const PathState middle{probe.at(where), where, 0};
    if (!(middle.distance.distance > 0)) return std::nullopt;
    const bool approaches = middle.distance.distance < reach && middle.distance.normal.dot(direction) < 0;
    (approaches ? near : far) = middle;
  }
  return isFar() ? near : far;
}

/// The nearest point of the path between where it comes near to the shape and its end, which is outside.
/// Returns  nothing if the path leads inside, or approaches all the way
std::optional<PathState> passingState(const ShapeProbe& probe, const NodePath& path, btScalar margin, btScalar reach,
                                      const PathState& met, const PathState& end) {
  const btVector3 rest = path.predicted - met.where;
  const btScalar length = rest.length();
  PathState last = met;
  btScalar gone = 0;
  for (int k = 0; k < kMaxPathSteps; ++k) {
    gone += std::max(last.distance.distance, kMet * margin);
    const btVector3 where = met.where + (gone / length) * rest;
    const PathState here = gone < length ? PathState{probe.at(where), where, 0} : end;
    if (!(here.distance.distance > 0)) return std::nullopt;
    if (here.distance.distance >= reach || !(here.distance.normal.dot(rest) < 0)) {
      return turningState(probe, path, margin, reach, last, here);
    }
    if (!(gone < length)) return std::nullopt;
    last = here;
  }
  return std::nullopt;
}

}  // namespace

PathState firstInReach(const ShapeProbe& probe, const NodePath& path, btScalar reach) {
  const btVector3 direction = path.predicted - path.now;
  const btScalar length = direction.length();
  btScalar gone = 0;
  PathState met, last;
  met.where = path.now;
  for (int k = 0; k < kMaxPathSteps; ++k) {
    const ShapeDistance here = probe.at(met.where);
    const btScalar free = here.distance - reach;
    if (k == 0) met.clear = btMax(free, btScalar(0));
    if (free <= kMet * reach && (gone > 0 || free <= 0)) return {here, met.where, 0};
    if (free >= length - gone) return met;
    last = {here, met.where, 0};
    gone += std::max(free, kMet * reach);
    if (gone >= length) break;
    met.where = path.now + (gone / length) * direction;
  }
  // The end of the path.
  met.where = path.predicted;
  const ShapeDistance there = probe.at(met.where);
  if (there.distance < reach) met.distance = there;
  return there.distance < reach || gone >= length ? met : last;
}

PathState decidingState(const ShapeProbe& probe, const NodePath& path, btScalar margin, btScalar reach,
                        const PathState& met) {
  const btVector3 rest = path.predicted - met.where;
  const btScalar towards = met.distance.normal.dot(rest), aside = rest.length2() - towards * towards;
  const btScalar same = kSameDirection * met.distance.distance;
  if (!(towards < 0 && same > 0 && aside > same * same)) return met;
  const PathState end{probe.at(path.predicted), path.predicted, 0};
  if (!(end.distance.distance > 0)) return met;
  const btScalar level = kMet * margin;
  const bool isLast = end.distance.distance < reach && end.distance.normal.dot(rest) <= level;
  const std::optional<PathState> nearest = isLast ? end : passingState(probe, path, margin, reach, met, end);
  const btVector3 foot = met.where - met.distance.distance * met.distance.normal;
  if (!nearest || heightAbove(*nearest, foot) > level) return met;
  // Its plane would block a path that passes at more than the margin and leaves the reach.
  const bool passes = !(end.distance.distance < reach) && !(nearest->distance.distance < margin);
  return passes && heightAbove(*nearest, path.predicted) < margin ? PathState{{}, path.now, 0} : *nearest;
}

}  // namespace tetskin::bullet_detail
