// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/contact_sides.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// Cosine above which two normals belong to one side: edges may be rounded while a sample slides over them.
constexpr btScalar kSameSide = btScalar(0.5);
/// Number of projections with which a side follows its sample along the surface.
constexpr int kProjections = 2;
/// Number of steps for which a sample's motion is traced back to find where it has entered.
constexpr int kStepsBack = 4;
/// A depth, in cubes of the grid, larger than the error of the grid.
constexpr btScalar kDeepCubes = 2;

bool unitNormal(const GridDistance& at, btVector3& normal) {
  const btScalar length = at.gradient.length();
  if (!(length > kNoDirection)) return false;
  normal = at.gradient / length;
  return true;
}

/// Finds the point of the surface nearest to a point close to it, and its normal there.
bool project(const DistanceGrid& grid, const btVector3& near, ContactSide& side) {
  GridDistance at;
  btVector3 normal;
  if (!grid.at(near, at) || !unitNormal(at, normal)) return false;
  side.point = near - at.distance * normal;
  side.normal = normal;
  return true;
}

/// The side through which a sample has entered, moved along the surface as the sample has moved.
ContactSide followed(const DistanceGrid& grid, const btVector3& rest, const ContactSide& before) {
  ContactSide side = before;
  for (int k = 0; k < kProjections; ++k) {
    const btVector3 direction = rest - side.point;
    ContactSide next = side;
    if (!project(grid, side.point + direction - direction.dot(side.normal) * side.normal, next)) break;
    if (next.normal.dot(side.normal) < kSameSide) break;  // across an edge, or onto another part of the surface
    side = next;
  }
  return side;
}

/// Finds the side through which a sample has entered, if it is already deep when first seen, by tracing its motion
/// back.
bool entered(const DistanceGrid& grid, const btVector3& rest, const btVector3& motion, ContactSide& side) {
  for (int k = 1; k <= kStepsBack; ++k) {
    GridDistance at;
    const btVector3 back = rest - static_cast<btScalar>(k) * motion;
    if (!grid.at(back, at)) return false;
    if (at.distance >= 0) return project(grid, back, side);
  }
  return false;
}

}  // namespace

void ContactSides::beginStep() {
  before_.swap(now_);
  now_.clear();
  next_ = 0;
}

const ContactSide* ContactSides::find(int sample, const btVector3& rest, btScalar within) {
  while (next_ < before_.size() && before_[next_].sample < sample) ++next_;
  assert(next_ == 0 || before_[next_ - 1].sample < sample);
  const ContactSide* nearest = nullptr;
  btScalar minimum = within * within;
  for (std::size_t k = next_; k < before_.size() && before_[k].sample == sample; ++k) {
    const btScalar squared = (before_[k].point - rest).length2();
    if (squared < minimum) nearest = &before_[k];
    minimum = std::min(minimum, squared);
  }
  return nearest;
}

void ContactSides::clear() {
  before_.clear();
  now_.clear();
  next_ = 0;
}

/// Sides of the step before are not saved: the next step replaces them when it begins.
void ContactSides::serialize(bullet_detail::WorldStream& stream) {
  if (stream.restoring()) clear();
  stream.each(now_, [&](ContactSide& side) { stream(side.sample, side.point, side.normal); });
}

bool asksForMotion(const DistanceGrid& grid, const GridDistance& nearest, const ContactSide* before) {
  return !before && !(nearest.distance > -kDeepCubes * grid.spacing());
}

bool findSide(const DistanceGrid& grid, const btVector3& rest, const GridDistance& nearest, const btVector3& motion,
              const ContactSide* before, SideDistance& result) {
  assert(grid.spacing() > 0);
  btVector3 normal(0, 0, 0);
  const bool known = unitNormal(nearest, normal);
  result.distance = nearest.distance;
  result.side.point = rest - nearest.distance * normal;
  result.side.normal = normal;
  if (!before) {
    const bool leaving = known && motion.dot(normal) > 0;
    if (!asksForMotion(grid, nearest, before) || (known && !leaving)) return known;
    if (!entered(grid, rest, motion, result.side)) return known;
    result.distance = (rest - result.side.point).dot(result.side.normal);
    return true;
  }
  if (known && normal.dot(before->normal) > kSameSide) return true;
  const ContactSide side = followed(grid, rest, *before);
  if (known && normal.dot(side.normal) > kSameSide) return true;
  const btScalar distance = (rest - side.point).dot(side.normal);
  // The sample is outside, and not behind its side: the nearest surface is the correct one.
  if (known && nearest.distance >= 0 && distance >= 0) return true;
  result.side = side;
  result.distance = distance;
  return true;
}

}  // namespace tetskin::contact_detail
