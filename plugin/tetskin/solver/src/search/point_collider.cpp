// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/larger.h>
#include <tetskin/solver/src/search/point_collider.h>
#include <tetskin/solver/src/search/point_path.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Cosine between normals from which on they are of one plane.
constexpr btScalar kSamePlane = btScalar(0.9999);
/// Largest distance, in units of the slack, between a patch's touching points and the chosen ones.
constexpr btScalar kSpacing = 4;
/// A depth greater by one weighs as much as this much more distance from the chosen points.
constexpr btScalar kDepthsWorth = 3;
/// Distance, in units of the slack, by which a patch in touch may move before it is searched again: well below the
/// margin, so it is not visible.
constexpr btScalar kFollowedWay = btScalar(0.002);
/// Steps after which clear regions are searched again.
constexpr unsigned kRemembered = 16;

}  // namespace

/// An upper bound of the change of a unit vector between two rotations.
btScalar turnBetween(const btMatrix3x3& a, const btMatrix3x3& b) {
  btScalar squared = 0;
  for (int k = 0; k < 3; ++k) squared += (a[k] - b[k]).length2();
  return btSqrt(squared);
}

PointCollider::PointCollider(ContactPatches patches, btScalar slack) : patches_(std::move(patches)), slack_(slack) {
  assert(!(slack < 0));
  for (const PatchCluster& cluster : patches_.clusters) spread_ = std::max(spread_, cluster.spread);
}

void PointCollider::begin(const std::vector<NodePath>& nodes, btScalar margin, btScalar speculation) {
  assert(margin >= 0 && speculation >= 0);
  nodes_ = &nodes;
  margin_ = margin;
  speculation_ = speculation;
  reach_ = margin_ + speculation;
  clustersRead_ = false;
  local_.resize(nodes.size());
}

void PointCollider::readClusters() {
  if (clustersRead_) return;
  clustersRead_ = true;
  clusterBalls_.resize(patches_.clusters.size());
  std::size_t c = patches_.clusters.size();  // the tree is filled from its last leaf backwards
  const auto readLeaf = [&](const Bvh::Node&) {
    const PatchCluster& cluster = patches_.clusters[--c];
    BoxOfPaths box;
    for (std::uint32_t k = 0; k < cluster.nodeCount; ++k) {
      box.add((*nodes_)[static_cast<std::size_t>(patches_.clusterNodes[cluster.firstNode + k])]);
    }
    clusterBalls_[c] = box.ball(cluster.spread);
    return box.box(cluster.spread);
  };
  const auto aroundBoth = [](WorldBox box, const WorldBox& other) {
    box.extend(other);
    return box;
  };
  patches_.tree.fill(nodeBoxes_, readLeaf, aroundBoth);
  assert(c == 0);
}

const PointContacts& PointCollider::find(ShapeProbe& probe, const ShapePath& shape, ShapeMemory& memory,
                                         const WorldBox* around) {
  assert(nodes_);
  probe_ = &probe;
  shape_ = shape;
  touches_.clear();
  memory_ = &memory;
  ++memory.steps;
  assert(std::is_sorted(memory.touched.begin(), memory.touched.end()));
  if (isAllClear()) {
    memory.touched.clear();
    return touches_;
  }
  readClusters();
  searched_ = false;
  areSamples_.clear();
  toShape_ = {shape.now.inverse(), shape.predicted.inverse()};
  turn_ = turnBetween(toShape_.now.getBasis(), toShape_.predicted.getBasis());
  prepare(memory);
  const WorldBox near = around ? around->grownBy(reach_ + slack_) : WorldBox();
  if (!patches_.tree.empty() && searchNode(0, around ? &near : nullptr)) rememberAllClear();
  if (searched_) thinOutFace();  // what is followed has been chosen before
  rememberTouched();
  return touches_;
}

/// Searches the clusters below a node of the tree. True if all of them are clear.
/// near  everything outside of this box is clear; null: anything may be near
bool PointCollider::searchNode(std::size_t node, const WorldBox* near) {
  if (near && !nodeBoxes_[node].collides(*near)) return true;
  const int leaf = patches_.clusterOf[node];
  if (leaf < 0) {
    const bool firstClear = searchNode(node + 1, near);
    return searchNode(static_cast<std::size_t>(patches_.tree.nodes()[node].right), near) && firstClear;
  }
  const auto c = static_cast<std::size_t>(leaf);
  const bool again = !probe_->isKnownByItsBox() && (memory_->steps + c) % kRemembered == 0;
  const Ball ball = localBall(c);
  btScalar left = again ? btScalar(0) : clearance(c, ball);
  if (!(left > 0)) left = searchCluster(c, ball, again);
  return left > slack_ / 2;
}

void PointCollider::rememberTouched() {
  memory_->touched.clear();
  for (const PointContact& touch : touches_) memory_->touched.push_back(touch.point);
  std::sort(memory_->touched.begin(), memory_->touched.end());
}

void PointCollider::prepare(ShapeMemory& memory) const {
  memory.clusterBalls.resize(patches_.clusters.size());
  memory.clusterClear.resize(patches_.clusters.size(), 0);
  memory.carriers.resize(patches_.nodes.size());
  memory.clear.resize(patches_.patches.size(), 0);
  memory.followed.resize(patches_.patches.size(), 0);
}

/// True if no point has moved by half the slack since all points were found clear by that distance.
bool PointCollider::isAllClear() const {
  const bool forgotten = memory_->steps >= memory_->clearUntil && !probe_->isKnownByItsBox();
  if (forgotten || memory_->nodes.size() != nodes_->size() ||
      !(shape_.now == memory_->position && shape_.predicted == memory_->position)) {
    return false;
  }
  const btScalar left = btScalar(0.5) * slack_ - std::max(speculation_ - memory_->speculation, btScalar(0));
  if (!(left > 0)) return false;
  const btScalar maximum = left * left / (spread_ * spread_);
  for (std::size_t n = 0; n < nodes_->size(); ++n) {
    const NodePath& path = (*nodes_)[n];
    if ((path.now - memory_->nodes[n]).length2() >= maximum) return false;
    if ((path.predicted - memory_->nodes[n]).length2() >= maximum) return false;
  }
  return true;
}

void PointCollider::rememberAllClear() {
  memory_->clearUntil = memory_->steps + kRemembered;
  memory_->position = shape_.now;
  memory_->speculation = speculation_;
  memory_->nodes.resize(nodes_->size());
  for (std::size_t n = 0; n < nodes_->size(); ++n) memory_->nodes[n] = (*nodes_)[n].now;
}

/// A ball around all paths in a cluster, in the shape's space.
Ball PointCollider::localBall(std::size_t cluster) const {
  assert(cluster < clusterBalls_.size());
  const Ball& world = clusterBalls_[cluster];
  const btVector3 now = toShape_.now * world.centre, predicted = toShape_.predicted * world.centre;
  return {(now + predicted) * btScalar(0.5), world.radius * (1 + turn_) + (predicted - now).length() * btScalar(0.5)};
}

/// A known lower bound of the cluster's distance from everything.
btScalar PointCollider::clearance(std::size_t cluster, const Ball& ball) const {
  assert(cluster < memory_->clusterClear.size());
  if (!(memory_->clusterClear[cluster] > 0)) return 0;
  const Ball& known = memory_->clusterBalls[cluster];
  const btScalar grown = std::max(ball.radius - known.radius, btScalar(0));
  return memory_->clusterClear[cluster] - speculation_ - (ball.centre - known.centre).length() - grown;
}

/// Returns the clearance of the whole cluster, or 0.
btScalar PointCollider::searchCluster(std::size_t cluster, const Ball& ball, bool again) {
  const PatchCluster& patches = patches_.clusters[cluster];
  assert(patches.firstPatch + patches.patchCount <= patches_.patches.size());
  readCluster(patches);
  memory_->clusterClear[cluster] = 0;
  bool entered = false;
  ShapeBound bound;
  btScalar left = slack_;
  const bool flat = probe_->isHalfSpace(ball);
  for (std::size_t p = patches.firstPatch; p < patches.firstPatch + patches.patchCount; ++p) {
    const ContactPatch& patch = patches_.patches[p];
    if (patch.isTriangle() && flat) continue;
    readPatch(patch);
    const btScalar still = again ? btScalar(0) : clearance(patch, memory_->clear[p]);
    if (still > 0) {
      left = std::min(left, still);
      continue;
    }
    if (!again && isFollowed(p)) {
      left = 0;
      follow(p);
      continue;
    }
    if (!entered && !probe_->enter(ball, reach_ + slack_)) {
      memory_->clusterBalls[cluster] = ball;
      memory_->clusterClear[cluster] = slack_ + speculation_;
      return slack_;
    }
    if (!entered) bound = probe_->bound();
    entered = true;
    const std::size_t first = touches_.size();
    const btScalar clear = searchPatch(patch, bound);
    areSamples_.resize(touches_.size(), patch.isTriangle());
    left = std::min(left, clear);
    remember(p, clear > 0 ? clear + speculation_ : btScalar(0));
    if (touches_.size() == first) continue;
    searched_ = true;
    if (probe_->isKnownByItsBox()) startFollowing(p);
  }
  return left;
}

void PointCollider::readCluster(const PatchCluster& cluster) {
  for (std::uint32_t k = 0; k < cluster.nodeCount; ++k) {
    const auto node = static_cast<std::size_t>(patches_.clusterNodes[cluster.firstNode + k]);
    assert(node < nodes_->size());
    const NodePath& world = (*nodes_)[node];
    local_[node] = {toShape_.now * world.now, toShape_.predicted * world.predicted};
  }
}

void PointCollider::readPatch(const ContactPatch& patch) {
  assert(patch.nodeCount > 0 && patch.nodeCount <= kMaxCarriers);
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    carriers_[n] = local_[static_cast<std::size_t>(patches_.nodes[patch.firstNode + n])];
  }
}

/// What remains of a patch's clearance after its nodes have moved.
btScalar PointCollider::clearance(const ContactPatch& patch, btScalar known) const {
  if (!(known > 0)) return 0;
  btScalar moved = 0;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    const btVector3& from = memory_->carriers[patch.firstNode + n];
    moved = larger(larger(moved, (carriers_[n].now - from).length2()), (carriers_[n].predicted - from).length2());
  }
  return known - speculation_ - btSqrt(moved) * patch.spread;
}

/// From where it has just been remembered.
void PointCollider::startFollowing(std::size_t patch) {
  memory_->clear[patch] = -reach_;
  memory_->followed[patch] = memory_->steps;
}

/// True if the patch touched in the last step, and has hardly moved since it was searched: no other points of it touch.
bool PointCollider::isFollowed(std::size_t patch) const {
  const btScalar known = memory_->clear[patch];
  if (!(known < 0) || reach_ > -known || memory_->followed[patch] + 1 != memory_->steps) return false;
  const btScalar moves = kFollowedWay * slack_, falls = moves + restingApproach();
  const ContactPatch& of = patches_.patches[patch];
  for (std::uint32_t n = 0; n < of.nodeCount; ++n) {
    const btVector3& from = memory_->carriers[of.firstNode + n];
    if (!((carriers_[n].now - from).length2() <= moves * moves)) return false;
    if (!((carriers_[n].predicted - from).length2() <= falls * falls)) return false;
  }
  return true;
}

/// Looks at the points alone with which the patch touched in the last step.
void PointCollider::follow(std::size_t patch) {
  const ContactPatch& of = patches_.patches[patch];
  memory_->followed[patch] = memory_->steps;
  if (of.isTriangle()) readCorners(of);
  const std::size_t first = touches_.size();
  const std::vector<std::uint32_t>& known = memory_->touched;
  for (auto at = std::lower_bound(known.begin(), known.end(), of.firstPoint);
       at != known.end() && *at < of.firstPoint + of.numberCount(); ++at) {
    (void)touch(of, *at - of.firstPoint);
  }
  setCarried(of, first);
  areSamples_.resize(touches_.size(), of.isTriangle());
}

void PointCollider::remember(std::size_t patch, btScalar clear) {
  assert(patch < memory_->clear.size() && memory_->carriers.size() == patches_.nodes.size());
  const ContactPatch& touched = patches_.patches[patch];
  memory_->clear[patch] = clear;
  for (std::uint32_t n = 0; n < touched.nodeCount; ++n) memory_->carriers[touched.firstNode + n] = carriers_[n].now;
}

/// Returns the clearance of all points of the patch at the beginning of their paths.
btScalar PointCollider::searchPatch(const ContactPatch& patch, const ShapeBound& clusterBound) {
  if (patch.isTriangle()) return searchTriangle(patch, clusterBound);
  const btScalar far = lowestHeight(patch, clusterBound) - reach_;
  if (far > slack_) return far;
  BoxOfPaths box;
  btScalar longest = 0;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    box.add(carriers_[n]);
    longest = std::max(longest, (carriers_[n].predicted - carriers_[n].now).length2());
  }
  // The reach covers a point's whole path from its beginning.
  const btScalar reach = reach_ + slack_ + btSqrt(longest) * patch.spread;
  const CarrierPaths carriers{carriers_.data(), patch.nodeCount, patch.spread};
  if (!probe_->narrow(carriers, box.ball(patch.spread), reach)) return slack_;
  const btScalar nearer = lowestHeight(patch, probe_->bound()) - reach_;
  return nearer > 0 ? nearer : searchPoints(patch);
}

/// The smallest height above the bound that a point can have on its path: the lowest of its nodes, minus how far it may
/// be outside of them.
btScalar PointCollider::lowestHeight(const ContactPatch& patch, const ShapeBound& bound) {
  btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    heights_[0][n] = bound(carriers_[n].now);
    heights_[1][n] = bound(carriers_[n].predicted);
    low = std::min({low, heights_[0][n], heights_[1][n]});
    high = std::max({high, heights_[0][n], heights_[1][n]});
  }
  return (low + high - patch.spread * (high - low)) * btScalar(0.5);
}

btScalar PointCollider::searchPoints(const ContactPatch& patch) {
  const btScalar* weights = &patches_.weights[patch.firstWeight];
  const std::size_t first = touches_.size();
  btScalar clear = slack_;
  for (std::uint32_t p = 0; p < patch.pointCount; ++p, weights += patch.nodeCount) {
    btScalar now = 0, predicted = 0;
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      now += weights[n] * heights_[0][n];
      predicted += weights[n] * heights_[1][n];
    }
    const btScalar height = std::min(now, predicted) - reach_;
    clear = std::min(clear, height > 0 ? height : touch(patch, p));
  }
  finishPatch(patch, first);
  return clear;
}

NodePath PointCollider::pathOf(const ContactPatch& patch, std::uint32_t point) const {
  assert(point < patch.numberCount());
  if (patch.isTriangle()) {
    const std::uint32_t row = patch.divisions + 1;
    return sampleAt(patch, static_cast<int>(point / row), static_cast<int>(point % row));
  }
  const btScalar* weights = &patches_.weights[patch.firstWeight + point * patch.nodeCount];
  NodePath path{btVector3(0, 0, 0), btVector3(0, 0, 0)};
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    path.now += weights[n] * carriers_[n].now;
    path.predicted += weights[n] * carriers_[n].predicted;
  }
  return path;
}

/// Returns the point's clearance at the beginning of its path.
btScalar PointCollider::touch(const ContactPatch& patch, std::uint32_t point) {
  const NodePath path = pathOf(patch, point);
  const PathState met = firstInReach(*probe_, path, reach_);
  if (!(met.distance.distance < BT_LARGE_FLOAT)) return met.clear;
  const PathState state = decidingState(*probe_, path, margin_, reach_, met);
  if (!(state.distance.distance < BT_LARGE_FLOAT)) return state.clear;
  const btVector3& normal = state.distance.normal;
  PointContact touch;
  touch.distance = heightAbove(state, path.now) - margin_;
  touch.predicted = touch.distance + normal.dot(path.predicted - path.now);
  // A point that is too near is pushed out, whatever its direction of motion.
  if (!(touch.predicted < speculation_ || touch.distance < speculation_)) return 0;
  touch.position = shape_.now * path.now;
  touch.normal = shape_.now.getBasis() * normal;
  touch.point = patch.firstPoint + point;
  touches_.push_back(touch);
  return 0;
}

/// first  index of the patch's first touch
void PointCollider::finishPatch(const ContactPatch& patch, std::size_t first) {
  chooseTouches(patch, first);
  setCarried(patch, first);
}

void PointCollider::setCarried(const ContactPatch& patch, std::size_t first) {
  for (std::size_t k = first; k < touches_.size(); ++k) {
    touches_[k].at = patches_.carriedPoint(patch, touches_[k].point - patch.firstPoint);
  }
}

bool PointCollider::isKnown(const PointContact& touch) const {
  return std::binary_search(memory_->touched.begin(), memory_->touched.end(), touch.point);
}

/// Chooses points of the patch: first the deepest one, then those that already bear a load, and then those farthest
/// from the ones already chosen. Points that touched in the last step get an advantage, so that the choice is stable: a
/// resting body sticks at these points.
void PointCollider::chooseTouches(const ContactPatch& patch, std::size_t first) {
  assert(first <= touches_.size());
  if (touches_.size() - first <= 2) return;
  const auto begin = touches_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto lead = [&](const PointContact& touch) { return isKnown(touch) ? kSpacing * slack_ : btScalar(0); };
  // In a longer step, more points are near; that must not change which ones bear a load.
  const auto bears = [&](const PointContact& touch) { return touch.distance < 0 && isKnown(touch); };
  chosen_.clear();
  auto next = std::min_element(begin, touches_.end(), [&](const PointContact& a, const PointContact& b) {
    return a.predicted - lead(a) < b.predicted - lead(b);
  });
  apart_.assign(touches_.size() - first, BT_LARGE_FLOAT);
  // The patch lies or slides on a plane: it moves as a whole, so a few points support it. A patch that falls onto one
  // does not qualify: points between the chosen ones would penetrate.
  const btScalar approach = restingApproach();
  const bool flat = std::all_of(begin, touches_.end(), [&](const PointContact& touch) {
    return touch.normal.dot(begin->normal) > kSamePlane && touch.distance - touch.predicted < approach;
  });
  const std::size_t few = first < kManyTouches ? kMinTouches : 2;
  const std::size_t usual = flat ? few : (patch.isTriangle() ? kTriangleTouches : kMaxTouches);
  const auto bearing = static_cast<std::size_t>(std::count_if(begin, touches_.end(), bears));
  const std::size_t enough = std::min(std::max(usual, bearing), kMaxTouches);
  const auto enoughApart = [&] { return chosen_.size() < kMinTouches ? btScalar(0) : kSpacing * slack_; };
  for (;;) {
    chosen_.push_back(*next);
    if (chosen_.size() == enough) break;
    btScalar maximum = -BT_LARGE_FLOAT;
    for (auto at = begin; at != touches_.end(); ++at) {
      btScalar& apart = apart_[static_cast<std::size_t>(at - begin)];
      apart = std::min(apart, (at->position - chosen_.back().position).length());
      const bool stays = bears(*at);
      const btScalar gain = stays ? BT_LARGE_FLOAT : apart + lead(*at) - kDepthsWorth * at->predicted;
      if (apart <= (stays ? btScalar(0) : enoughApart()) || gain <= maximum) continue;
      maximum = gain;
      next = at;
    }
    if (!(maximum > -BT_LARGE_FLOAT)) break;
  }
  touches_.erase(begin, touches_.end());
  touches_.insert(touches_.end(), chosen_.begin(), chosen_.end());
  assert(touches_.size() - first <= kMaxTouches);
}

}  // namespace tetskin::bullet_detail
