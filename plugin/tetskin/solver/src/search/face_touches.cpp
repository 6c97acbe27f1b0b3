// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The part of PointCollider that bounds how many samples hold a face on a face. Points in one plane press on the nodes
// that carry them, and on the shape at places which these nodes determine: many more points than nodes change nothing
// but the cost. Of each node the point stays that presses on it most, and the points at the outline, which decide
// whether the shape tips over. Vertices always stay: those of a curved skin do not lie where nodes determine it.
#include <tetskin/solver/src/search/point_collider.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// No sample is left out of so few.
constexpr std::size_t kFewOnFace = 8;
/// Squared difference of normals on one face of a shape: rounding. On edges, normals are similar.
constexpr btScalar kSameFace = btScalar(1e-10);
/// A node on which no point presses with more than this weight needs none.
constexpr btScalar kLeastWeight = btScalar(0.1);
/// Factor on the weights of points that touched in the last step, and how much farther out they count at the outline,
/// in units of the slack: a resting body sticks at these.
constexpr btScalar kStays = btScalar(1.25), kStaysFarther = btScalar(0.2);
/// Height in units of the slack: points above it do not press yet, and those as deep always stay.
constexpr btScalar kLevel = btScalar(0.02);
/// What such a point above it counts less: a factor on its weights, and the distance at the outline, in units of the
/// slack.
constexpr btScalar kAbove = btScalar(0.5), kAboveFarther = btScalar(4);

/// Width in units of the slack up to which points are in a line.
constexpr btScalar kLine = btScalar(8);

}  // namespace

/// Lists the touches on the shape's face that the deepest one is on; none if any of them moves towards it: a face that
/// falls onto another one would penetrate between the points that stay.
void PointCollider::listFace() {
  assert(areSamples_.size() == touches_.size());
  face_.clear();
  if (static_cast<std::size_t>(std::count(areSamples_.begin(), areSamples_.end(), 1)) <= kFewOnFace) return;
  const auto deepest =
      std::min_element(touches_.begin(), touches_.end(),
                       [](const PointContact& a, const PointContact& b) { return a.predicted < b.predicted; });
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const PointContact& touch = touches_[k];
    if (!((touch.normal - deepest->normal).length2() < kSameFace)) continue;
    face_.push_back(k);
    if (touch.distance - touch.predicted < restingApproach()) continue;
    face_.clear();
    return;
  }
}

void PointCollider::thinOutFace() {
  listFace();
  if (face_.empty()) return;
  stays_.assign(touches_.size(), 1);
  for (const std::size_t k : face_) stays_[k] = !areSamples_[k] || touches_[k].distance < -kLevel * slack_;
  keepForNodes();
  if (!keepOutline()) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    if (stays_[k]) touches_[kept++] = touches_[k];
  }
  touches_.resize(kept);
}

void PointCollider::keepForNodes() {
  mostPressing_.resize(nodes_->size());
  const auto forWeights = [&](auto&& call) {
    for (const std::size_t k : face_) {
      const CarriedPoint& at = touches_[k].at;
      for (std::uint32_t n = 0; n < at.count; ++n) {
        call(k, mostPressing_[static_cast<std::size_t>(at.nodes[n])], at.weights[n]);
      }
    }
  };
  forWeights([&](std::size_t k, Pressing& most, btScalar weight) {
    const btScalar stays = isKnown(touches_[k]) ? kStays : btScalar(1);
    const btScalar counts = weight * stays * (touches_[k].distance > kLevel * slack_ ? kAbove : btScalar(1));
    if (counts > most.weight) most = {k, counts};
  });
  forWeights([&](std::size_t k, const Pressing& most, btScalar) {
    if (most.weight > kLeastWeight && most.touch == k) stays_[k] = 1;
  });
  forWeights([&](std::size_t, Pressing& most, btScalar) { most = {}; });
}

/// Keeps the farthest points in eight directions. False if all points are in a line: these rock when they change.
bool PointCollider::keepOutline() {
  assert(!face_.empty());
  const btScalar half = btSqrt(btScalar(0.5));
  btVector3 u, v;
  btPlaneSpace1(touches_[face_.front()].normal, u, v);
  btScalar narrowest = BT_LARGE_FLOAT;
  for (const btVector3& axis : {u, v, half * (u + v), half * (u - v)}) {
    const auto farthest = [&](btScalar sign) {
      const auto reaches = [&](std::size_t k) {
        const PointContact& touch = touches_[k];
        const btScalar counts = (isKnown(touch) ? kStaysFarther : btScalar(0)) -
                                (touch.distance > kLevel * slack_ ? kAboveFarther : btScalar(0));
        return sign * axis.dot(touch.position) + counts * slack_;
      };
      return *std::max_element(face_.begin(), face_.end(),
                               [&](std::size_t a, std::size_t b) { return reaches(a) < reaches(b); });
    };
    const std::size_t first = farthest(-1), last = farthest(1);
    stays_[first] = stays_[last] = 1;
    narrowest = std::min(narrowest, axis.dot(touches_[last].position - touches_[first].position));
  }
  return narrowest > kLine * slack_;
}

}  // namespace tetskin::bullet_detail
