// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   John C. Hart, "Sphere Tracing", The Visual Computer 12, 1996 (steps of the distance on a straight way)
#include <tetskin/contact/src/rigid/touch_search.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Steps on the way of a point. After these it counts as meeting what it has come near to.
constexpr int kMostSteps = 24;
/// How near counts as met, over the margin.
constexpr btScalar kMet = btScalar(0.05);

class BoxOfPaths {
 public:
  void add(const NodePath& path) {
    low_.setMin(path.now);
    low_.setMin(path.predicted);
    high_.setMax(path.now);
    high_.setMax(path.predicted);
  }
  Ball ball(btScalar spread) const {
    return {(low_ + high_) * btScalar(0.5), (high_ - low_).length() * btScalar(0.5) * spread};
  }

 private:
  btVector3 low_{BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT};
  btVector3 high_{-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT};
};

/// What a point meets first on its straight way, no farther from it than the margin.
/// Returns the distance to it there, and in `where` the place; BT_LARGE_FLOAT if it meets nothing.
ShapeDistance firstMet(const ShapeProbe& probe, const NodePath& path, btScalar margin, btVector3& where) {
  const btVector3 way = path.predicted - path.now;
  const btScalar length = way.length();
  btScalar gone = 0;
  where = path.now;
  for (int k = 0; k < kMostSteps; ++k) {
    const ShapeDistance here = probe.at(where);
    const btScalar free = here.distance - margin;
    if (free <= kMet * margin && (gone > 0 || free <= 0)) return here;
    if (free >= length - gone) return {};
    gone += std::max(free, kMet * margin);
    if (gone >= length) break;
    where = path.now + (gone / length) * way;
  }
  // The last bit of the way.
  where = path.predicted;
  const ShapeDistance there = probe.at(where);
  return there.distance < margin ? there : ShapeDistance{};
}

/// Largest change of a unit vector between two rotations, or more.
btScalar turnBetween(const btMatrix3x3& a, const btMatrix3x3& b) {
  btScalar squared = 0;
  for (int k = 0; k < 3; ++k) squared += (a[k] - b[k]).length2();
  return btSqrt(squared);
}

}  // namespace

TouchSearch::TouchSearch(ContactPatches patches, btScalar margin, btScalar share)
    : patches_(std::move(patches)), margin_(margin), share_(share) {}

void TouchSearch::begin(const std::vector<NodePath>& nodes) {
  nodes_ = &nodes;
  placeOf_.resize(nodes.size(), -1);
  local_.resize(nodes.size());
  clusterBalls_.clear();
  for (const PatchCluster& cluster : patches_.clusters) {
    BoxOfPaths box;
    for (std::uint32_t k = 0; k < cluster.nodeCount; ++k) {
      box.add(nodes[static_cast<std::size_t>(patches_.clusterNodes[cluster.firstNode + k])]);
    }
    clusterBalls_.push_back(box.ball(cluster.spread));
  }
}

const std::vector<NodeTouch>& TouchSearch::find(ShapeProbe& probe, const ShapePath& shape) {
  assert(nodes_ && clusterBalls_.size() == patches_.clusters.size());
  probe_ = &probe;
  shape_ = shape;
  toShape_ = {shape.now.inverse(), shape.predicted.inverse()};
  turn_ = turnBetween(toShape_.now.getBasis(), toShape_.predicted.getBasis());
  touches_.clear();
  for (std::size_t c = 0; c < clusterBalls_.size(); ++c) {
    const Ball& world = clusterBalls_[c];
    const btVector3 now = toShape_.now * world.centre, predicted = toShape_.predicted * world.centre;
    const Ball ball{(now + predicted) * btScalar(0.5),
                    world.radius * (1 + turn_) + (predicted - now).length() * btScalar(0.5)};
    if (probe.enter(ball, margin_)) searchCluster(patches_.clusters[c]);
  }
  for (const NodeTouch& touch : touches_) placeOf_[static_cast<std::size_t>(touch.node)] = -1;
  std::sort(touches_.begin(), touches_.end(), [](const NodeTouch& a, const NodeTouch& b) { return a.node < b.node; });
  return touches_;
}

void TouchSearch::searchCluster(const PatchCluster& cluster) {
  readCluster(cluster);
  const ShapeBound bound = probe_->bound();
  for (std::uint32_t k = 0; k < cluster.patchCount; ++k) {
    const ContactPatch& patch = patches_.patches[cluster.firstPatch + k];
    BoxOfPaths box;
    btScalar longest = 0;
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      carriers_[n] = local_[static_cast<std::size_t>(patches_.nodes[patch.firstNode + n])];
      box.add(carriers_[n]);
      longest = std::max(longest, (carriers_[n].predicted - carriers_[n].now).length2());
    }
    // So far that a point's whole way is within reach of where it begins.
    const btScalar reach = margin_ + btSqrt(longest) * patch.spread;
    if (mayMeet(patch, bound) &&
        probe_->narrow({carriers_.data(), patch.nodeCount, patch.spread}, box.ball(patch.spread), reach) &&
        mayMeet(patch, probe_->bound())) {
      searchPatch(patch);
    }
  }
}

void TouchSearch::readCluster(const PatchCluster& cluster) {
  for (std::uint32_t k = 0; k < cluster.nodeCount; ++k) {
    const auto node = static_cast<std::size_t>(patches_.clusterNodes[cluster.firstNode + k]);
    const NodePath& world = (*nodes_)[node];
    local_[node] = {toShape_.now * world.now, toShape_.predicted * world.predicted};
  }
}

/// Leaves the heights of the nodes above the bound: a point's is between them, weighted as it is.
bool TouchSearch::mayMeet(const ContactPatch& patch, const ShapeBound& bound) {
  btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    heights_[0][n] = bound(carriers_[n].now);
    heights_[1][n] = bound(carriers_[n].predicted);
    low = std::min({low, heights_[0][n], heights_[1][n]});
    high = std::max({high, heights_[0][n], heights_[1][n]});
  }
  return (low + high - patch.spread * (high - low)) * btScalar(0.5) <= margin_;
}

void TouchSearch::searchPatch(const ContactPatch& patch) {
  const btScalar* weights = &patches_.weights[patch.firstWeight];
  for (std::uint32_t p = 0; p < patch.pointCount; ++p, weights += patch.nodeCount) {
    btScalar now = 0, predicted = 0;
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      now += weights[n] * heights_[0][n];
      predicted += weights[n] * heights_[1][n];
    }
    if (std::min(now, predicted) <= margin_) touch(patch, p);
  }
}

NodePath TouchSearch::pathOf(const ContactPatch& patch, std::uint32_t point) const {
  const btScalar* weights = &patches_.weights[patch.firstWeight + point * patch.nodeCount];
  NodePath path{btVector3(0, 0, 0), btVector3(0, 0, 0)};
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    path.now += weights[n] * carriers_[n].now;
    path.predicted += weights[n] * carriers_[n].predicted;
  }
  return path;
}

void TouchSearch::touch(const ContactPatch& patch, std::uint32_t point) {
  const NodePath path = pathOf(patch, point);
  btVector3 where;
  const ShapeDistance met = firstMet(*probe_, path, margin_, where);
  if (!(met.distance < BT_LARGE_FLOAT)) return;
  NodeTouch touch;
  touch.distance = met.distance - margin_ + met.normal.dot(path.now - where);
  touch.predicted = touch.distance + met.normal.dot(path.predicted - path.now);
  if (!(touch.predicted < 0)) return;
  touch.position = shape_.now * path.now;
  touch.normal = shape_.now.getBasis() * met.normal;
  keep(patch, point, touch);
}

/// The nodes that carry a point hold it; each node the one that would go deepest.
void TouchSearch::keep(const ContactPatch& patch, std::uint32_t point, const NodeTouch& touch) {
  const btScalar* acting = &patches_.acting[patch.firstWeight + point * patch.nodeCount];
  const btScalar least = std::min(share_, *std::max_element(acting, acting + patch.nodeCount));
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    if (acting[n] < least) continue;
    const int node = patches_.nodes[patch.firstNode + n];
    int& place = placeOf_[static_cast<std::size_t>(node)];
    if (place < 0) {
      place = static_cast<int>(touches_.size());
      touches_.push_back(touch);
    } else if (touch.predicted < touches_[static_cast<std::size_t>(place)].predicted) {
      touches_[static_cast<std::size_t>(place)] = touch;
    } else {
      continue;
    }
    touches_[static_cast<std::size_t>(place)].node = node;
    touches_[static_cast<std::size_t>(place)].point = patch.firstPoint + point;
  }
}

}  // namespace tetskin
