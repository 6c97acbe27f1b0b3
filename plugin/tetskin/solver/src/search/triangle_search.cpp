// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The part of PointCollider that searches the samples on a triangle. Parts are cut into four, down to single samples
// only where the shape is near and curved. Where a part meets a plane, none of its points is deeper than its corners.
#include <tetskin/solver/src/search/point_collider.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace tetskin::bullet_detail {
namespace {

/// A shape counts as flat if it is this close to a plane that touches it, in units of the slack: well below the margin,
/// so it is not visible, and well above rounding.
constexpr btScalar kFlatShape = btScalar(0.01);

}  // namespace

/// A part of a triangle, with the corners (i, j), (i + size, j) and (i, j + size) among its samples. A negative size:
/// the part is turned by half a turn.
struct PointCollider::TrianglePart {
  int i = 0, j = 0, size = 0;
};

NodePath PointCollider::sampleAt(const ContactPatch& patch, int i, int j) const {
  assert(i >= 0 && j >= 0 && static_cast<std::uint32_t>(i + j) <= patch.divisions);
  const btScalar scale = 1 / static_cast<btScalar>(patch.divisions);
  const btScalar second = scale * static_cast<btScalar>(i), third = scale * static_cast<btScalar>(j);
  const auto between = [&](btVector3 NodePath::*at) {
    return corners_[0].*at + second * (corners_[1].*at - corners_[0].*at) + third * (corners_[2].*at - corners_[0].*at);
  };
  return {between(&NodePath::now), between(&NodePath::predicted)};
}

void PointCollider::readCorners(const ContactPatch& patch) {
  assert(patch.isTriangle());
  const btScalar* weights = &patches_.weights[patch.firstWeight];
  for (NodePath& corner : corners_) {
    corner = {btVector3(0, 0, 0), btVector3(0, 0, 0)};
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n, ++weights) {
      corner.now += *weights * carriers_[n].now;
      corner.predicted += *weights * carriers_[n].predicted;
    }
  }
}

/// Returns the clearance of all samples of the triangle at the beginning of their paths.
btScalar PointCollider::searchTriangle(const ContactPatch& patch, const ShapeBound& clusterBound) {
  readCorners(patch);
  const std::size_t first = touches_.size();
  const btScalar clear = searchPart(patch, {0, 0, static_cast<int>(patch.divisions)}, clusterBound);
  finishPatch(patch, first);
  return clear;
}

/// around  bound that holds for a ball around the part
btScalar PointCollider::searchPart(const ContactPatch& patch, const TrianglePart& part, const ShapeBound& around) {
  const std::array<NodePath, 3> paths = {sampleAt(patch, part.i, part.j), sampleAt(patch, part.i + part.size, part.j),
                                         sampleAt(patch, part.i, part.j + part.size)};
  const CarrierPaths corners{paths.data(), paths.size(), 1};
  const auto clearOf = [&](const ShapeBound& bound) { return corners.lowest(bound.normal) + bound.offset - reach_; };
  const btScalar far = clearOf(around);
  if (far > slack_) return far;
  BoxOfPaths box;
  btScalar longest = 0;
  for (const NodePath& path : paths) {
    box.add(path);
    longest = std::max(longest, (path.predicted - path.now).length2());
  }
  // The reach covers a point's whole path from its beginning.
  const btScalar reach = reach_ + slack_ + btSqrt(longest);
  const Ball ball = box.ball(1);
  if (!probe_->narrow(corners, ball, reach)) return slack_;
  const ShapeBound bound = probe_->bound();
  const btScalar nearer = clearOf(bound);
  if (nearer > 0) return nearer;
  if (std::abs(part.size) == 1 || isFlat(corners, bound)) return touchCorners(patch, part);
  const int half = part.size / 2;
  btScalar clear = slack_;
  for (const TrianglePart& quarter :
       {TrianglePart{part.i, part.j, half}, TrianglePart{part.i + half, part.j, half},
        TrianglePart{part.i, part.j + half, half}, TrianglePart{part.i + half, part.j + half, -half}}) {
    clear = std::min(clear, searchPart(patch, quarter, bound));
  }
  return clear;
}

/// A sample belongs to the part whose first corner it is or, along the triangle's third edge, whose second; other parts
/// with this corner skip it.
btScalar PointCollider::touchCorners(const ContactPatch& patch, const TrianglePart& part) {
  const int n = static_cast<int>(patch.divisions);
  if (part.size < 0) return slack_;
  btScalar clear = part.size > 1 ? btScalar(0) : slack_;
  const auto look = [&](int i, int j) {
    if (std::max({i, j, n - i - j}) == n) return;  // a vertex
    clear = std::min(clear, touch(patch, static_cast<std::uint32_t>(i * (n + 1) + j)));
  };
  look(part.i, part.j);
  if (part.i + part.size + part.j == n) look(part.i + part.size, part.j);
  return clear;
}

/// True if the shape is as near as the bound allows at each corner: it is then as good as a plane. Distances of all
/// points between are no less than their heights above it.
bool PointCollider::isFlat(const CarrierPaths& corners, const ShapeBound& bound) const {
  assert(corners.count == 3);
  if (!(bound.offset > -BT_LARGE_FLOAT)) return false;
  const auto isTight = [&](const btVector3& at) { return probe_->at(at).distance - bound(at) <= kFlatShape * slack_; };
  return std::all_of(corners.paths, corners.paths + corners.count,
                     [&](const NodePath& path) { return isTight(path.now) && isTight(path.predicted); });
}

}  // namespace tetskin::bullet_detail
