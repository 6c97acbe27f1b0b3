// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/rows/friction_anchors.h>
#include <tetskin/solver/src/rows/position_rounding.h>

#include <algorithm>
#include <cassert>
#include <vector>

namespace tetskin::bullet_detail {
namespace {

/// Cosine: contacts of one point whose normals differ by less than this angle count as the same contact in the next
/// step.
constexpr btScalar kSameNormal = btScalar(0.7);

/// The anchor that the last step stored for this contact, with the same sample or with another one of the point,
/// because samples may take turns; or null.
const FrictionAnchor* anchorFrom(const std::vector<FrictionAnchor>& anchors, const ContactRow& row,
                                 const RowOrigin& origin) {
  const auto less = [](const FrictionAnchor& a, const FrictionAnchor& b) { return a.point < b.point; };
  FrictionAnchor key;
  key.point = origin.point;
  const auto range = std::equal_range(anchors.begin(), anchors.end(), key, less);
  const FrictionAnchor* found = nullptr;
  for (auto known = range.first; known != range.second; ++known) {
    if (known->object != origin.object || known->normal.dot(row.normal) < kSameNormal) continue;
    if (known->sample == origin.sample) return &*known;
    if (!found) found = &*known;
  }
  return found;
}

}  // namespace

void warmStart(const SolvedBody& body, const btVector3& remainder, const btTransform& frame, btScalar seconds,
               ContactRow& row, RowOrigin& origin) {
  assert(body.memory && seconds > 0);
  // In the object's frame, where sums keep digits that a position far from the origin lacks.
  const btVector3 here = frame.invXform(origin.position) + remainder * frame.getBasis();
  origin.stickingPosition = here;
  const FrictionAnchor* known = anchorFrom(body.memory->frictionAnchors, row, origin);
  if (!known) return;
  origin.stickingPosition = known->position;
  btVector3 offset = row.ends[1].isSoft() ? known->position : frame.getBasis() * (here - known->position);
  offset -= row.normal.dot(offset) * row.normal;
  const bool exact = body.elastic && !row.ends[1].isSoft() && origin.object->isStaticOrKinematicObject();
  row.offsetVelocity = (exact ? offset : visibleOffset(offset, origin.position)) / seconds;
  row.normalBound = known->normalForce * seconds;
  row.stuck = known->stuck;
}

FrictionAnchor frictionAnchorOf(const ContactRow& row, const RowOrigin& origin, btScalar seconds) {
  assert(origin.object && seconds > 0);
  FrictionAnchor kept;
  kept.point = origin.point;
  kept.sample = origin.sample;
  kept.object = origin.object;
  kept.normal = row.normal;
  const btScalar along = row.normal.dot(row.impulse);
  kept.normalForce = along / seconds;
  kept.position = origin.stickingPosition;
  kept.stuck = row.state == ContactRow::State::Sticks;
  if (row.ends[1].isSoft()) kept.position = (row.slip + row.offsetVelocity) * seconds;
  if (row.state != ContactRow::State::Slides || !(row.tangentStiffness > 0)) return kept;
  const btVector3 reached = (row.slip + row.offsetVelocity) * seconds;
  const btVector3 held = -(row.impulse - along * row.normal) * (seconds / row.tangentStiffness);
  if (row.ends[1].isSoft()) {
    kept.position = held;
    return kept;
  }
  kept.position += origin.object->getWorldTransform().getBasis().transpose() * (reached - held);
  return kept;
}

}  // namespace tetskin::bullet_detail
