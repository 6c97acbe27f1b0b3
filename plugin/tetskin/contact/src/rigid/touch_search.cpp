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
/// Over the slack: how far the points of a patch that touch may be from those of them that are chosen.
constexpr btScalar kSpacing = 4;
/// Cosine: a patch in one tet moves as a whole, and on a plane a few points hold it.
constexpr btScalar kSamePlane = btScalar(0.9999);
/// How far it goes to the plane in a step at most, over the slack.
constexpr btScalar kCalm = btScalar(0.25);
/// How much farther apart others must be than a point that goes deeper by one.
constexpr btScalar kDepthsWorth = 3;
/// Steps after which what was clear is looked at again.
constexpr unsigned kRemembered = 16;

/// What a point meets first on its straight way, no farther from it than the margin.
struct Meeting {
  ShapeDistance distance;  ///< there; BT_LARGE_FLOAT if it meets nothing
  btVector3 where;
  btScalar clear = 0;  ///< how far it is from meeting anything where it begins, if it meets nothing
};

Meeting firstMet(const ShapeProbe& probe, const NodePath& path, btScalar margin) {
  const btVector3 way = path.predicted - path.now;
  const btScalar length = way.length();
  btScalar gone = 0;
  Meeting met, last;
  met.where = path.now;
  for (int k = 0; k < kMostSteps; ++k) {
    const ShapeDistance here = probe.at(met.where);
    const btScalar free = here.distance - margin;
    if (k == 0) met.clear = btMax(free, btScalar(0));
    if (free <= kMet * margin && (gone > 0 || free <= 0)) return {here, met.where, 0};
    if (free >= length - gone) return met;
    last = {here, met.where, 0};
    gone += std::max(free, kMet * margin);
    if (gone >= length) break;
    met.where = path.now + (gone / length) * way;
  }
  // The last bit of the way.
  met.where = path.predicted;
  const ShapeDistance there = probe.at(met.where);
  if (there.distance < margin) met.distance = there;
  return there.distance < margin || gone >= length ? met : last;
}

/// Largest change of a unit vector between two rotations, or more.
btScalar turnBetween(const btMatrix3x3& a, const btMatrix3x3& b) {
  btScalar squared = 0;
  for (int k = 0; k < 3; ++k) squared += (a[k] - b[k]).length2();
  return btSqrt(squared);
}

}  // namespace

TouchSearch::TouchSearch(ContactPatches patches, btScalar margin, btScalar slack)
    : patches_(std::move(patches)), margin_(margin), slack_(slack) {
  for (const PatchCluster& cluster : patches_.clusters) spread_ = std::max(spread_, cluster.spread);
}

void TouchSearch::begin(const std::vector<NodePath>& nodes, btScalar speculation) {
  assert(speculation >= 0);
  nodes_ = &nodes;
  speculation_ = speculation;
  reach_ = margin_ + speculation;
  clustersRead_ = false;
  local_.resize(nodes.size());
}

void TouchSearch::readClusters() {
  if (clustersRead_) return;
  clustersRead_ = true;
  clusterBalls_.clear();
  for (const PatchCluster& cluster : patches_.clusters) {
    BoxOfPaths box;
    for (std::uint32_t k = 0; k < cluster.nodeCount; ++k) {
      box.add((*nodes_)[static_cast<std::size_t>(patches_.clusterNodes[cluster.firstNode + k])]);
    }
    clusterBalls_.push_back(box.ball(cluster.spread));
  }
}

const std::vector<PointTouch>& TouchSearch::find(ShapeProbe& probe, const ShapePath& shape, ShapeMemory& memory) {
  assert(nodes_);
  probe_ = &probe;
  shape_ = shape;
  touches_.clear();
  memory_ = &memory;
  ++memory.steps;
  if (isAllClear()) {
    memory.touched.clear();
    return touches_;
  }
  readClusters();
  toShape_ = {shape.now.inverse(), shape.predicted.inverse()};
  turn_ = turnBetween(toShape_.now.getBasis(), toShape_.predicted.getBasis());
  prepare(memory);
  bool allClear = true;
  for (std::size_t c = 0; c < clusterBalls_.size(); ++c) {
    const bool again = !probe.isKnownByItsBox() && (memory.steps + c) % kRemembered == 0;
    const Ball ball = localBall(c);
    btScalar left = again ? btScalar(0) : clearance(c, ball);
    if (!(left > 0)) left = searchCluster(c, ball, again);
    allClear = allClear && left > slack_ / 2;
  }
  if (allClear) rememberAllClear();
  rememberTouched();
  return touches_;
}

void TouchSearch::rememberTouched() {
  memory_->touched.clear();
  for (const PointTouch& touch : touches_) memory_->touched.push_back(touch.point);
  std::sort(memory_->touched.begin(), memory_->touched.end());
}

void TouchSearch::prepare(ShapeMemory& memory) const {
  memory.clusterBalls.resize(patches_.clusters.size());
  memory.clusterClear.resize(patches_.clusters.size(), 0);
  memory.carriers.resize(patches_.nodes.size());
  memory.clear.resize(patches_.patches.size(), 0);
}

/// No point has moved by half the slack since all was clear by as much.
bool TouchSearch::isAllClear() const {
  const bool forgotten = memory_->steps >= memory_->clearUntil && !probe_->isKnownByItsBox();
  if (forgotten || memory_->nodes.size() != nodes_->size() ||
      !(shape_.now == memory_->place && shape_.predicted == memory_->place)) {
    return false;
  }
  const btScalar left = btScalar(0.5) * slack_ - std::max(speculation_ - memory_->speculation, btScalar(0));
  if (!(left > 0)) return false;
  const btScalar most = left * left / (spread_ * spread_);
  for (std::size_t n = 0; n < nodes_->size(); ++n) {
    const NodePath& path = (*nodes_)[n];
    if ((path.now - memory_->nodes[n]).length2() >= most) return false;
    if ((path.predicted - memory_->nodes[n]).length2() >= most) return false;
  }
  return true;
}

void TouchSearch::rememberAllClear() {
  memory_->clearUntil = memory_->steps + kRemembered;
  memory_->place = shape_.now;
  memory_->speculation = speculation_;
  memory_->nodes.resize(nodes_->size());
  for (std::size_t n = 0; n < nodes_->size(); ++n) memory_->nodes[n] = (*nodes_)[n].now;
}

/// Of all the ways in a cluster.
Ball TouchSearch::localBall(std::size_t cluster) const {
  const Ball& world = clusterBalls_[cluster];
  const btVector3 now = toShape_.now * world.centre, predicted = toShape_.predicted * world.centre;
  return {(now + predicted) * btScalar(0.5), world.radius * (1 + turn_) + (predicted - now).length() * btScalar(0.5)};
}

/// How far the cluster is from everything at least, as far as that is known.
btScalar TouchSearch::clearance(std::size_t cluster, const Ball& ball) const {
  if (!(memory_->clusterClear[cluster] > 0)) return 0;
  const Ball& known = memory_->clusterBalls[cluster];
  const btScalar grown = std::max(ball.radius - known.radius, btScalar(0));
  return memory_->clusterClear[cluster] - speculation_ - (ball.centre - known.centre).length() - grown;
}

/// Returns by how much all of the cluster is clear, or 0.
btScalar TouchSearch::searchCluster(std::size_t cluster, const Ball& ball, bool again) {
  const PatchCluster& patches = patches_.clusters[cluster];
  readCluster(patches);
  memory_->clusterClear[cluster] = 0;
  bool entered = false;
  ShapeBound bound;
  btScalar left = slack_;
  for (std::size_t p = patches.firstPatch; p < patches.firstPatch + patches.patchCount; ++p) {
    const ContactPatch& patch = patches_.patches[p];
    readPatch(patch);
    const btScalar still = again ? btScalar(0) : clearance(patch, memory_->clear[p]);
    if (still > 0) {
      left = std::min(left, still);
      continue;
    }
    if (!entered && !probe_->enter(ball, reach_ + slack_)) {
      memory_->clusterBalls[cluster] = ball;
      memory_->clusterClear[cluster] = slack_ + speculation_;
      return slack_;
    }
    if (!entered) bound = probe_->bound();
    entered = true;
    const btScalar clear = searchPatch(patch, bound);
    remember(p, clear > 0 ? clear + speculation_ : btScalar(0));
    left = std::min(left, clear);
  }
  return left;
}

void TouchSearch::readCluster(const PatchCluster& cluster) {
  for (std::uint32_t k = 0; k < cluster.nodeCount; ++k) {
    const auto node = static_cast<std::size_t>(patches_.clusterNodes[cluster.firstNode + k]);
    const NodePath& world = (*nodes_)[node];
    local_[node] = {toShape_.now * world.now, toShape_.predicted * world.predicted};
  }
}

void TouchSearch::readPatch(const ContactPatch& patch) {
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    carriers_[n] = local_[static_cast<std::size_t>(patches_.nodes[patch.firstNode + n])];
  }
}

/// What is left of what the patch was clear by, now that its nodes have moved.
btScalar TouchSearch::clearance(const ContactPatch& patch, btScalar known) const {
  if (!(known > 0)) return 0;
  btScalar moved = 0;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    const btVector3& from = memory_->carriers[patch.firstNode + n];
    moved = std::max({moved, (carriers_[n].now - from).length2(), (carriers_[n].predicted - from).length2()});
  }
  return known - speculation_ - btSqrt(moved) * patch.spread;
}

void TouchSearch::remember(std::size_t patch, btScalar clear) {
  const ContactPatch& of = patches_.patches[patch];
  memory_->clear[patch] = clear;
  for (std::uint32_t n = 0; n < of.nodeCount; ++n) memory_->carriers[of.firstNode + n] = carriers_[n].now;
}

/// Returns how far all its points are, where they begin, from meeting anything.
btScalar TouchSearch::searchPatch(const ContactPatch& patch, const ShapeBound& clusterBound) {
  const btScalar far = lowestHeight(patch, clusterBound) - reach_;
  if (far > slack_) return far;
  BoxOfPaths box;
  btScalar longest = 0;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    box.add(carriers_[n]);
    longest = std::max(longest, (carriers_[n].predicted - carriers_[n].now).length2());
  }
  // So far that a point's whole way is within reach of where it begins.
  const btScalar reach = reach_ + slack_ + btSqrt(longest) * patch.spread;
  const CarrierPaths carriers{carriers_.data(), patch.nodeCount, patch.spread};
  if (!probe_->narrow(carriers, box.ball(patch.spread), reach)) return slack_;
  const btScalar nearer = lowestHeight(patch, probe_->bound()) - reach_;
  return nearer > 0 ? nearer : searchPoints(patch);
}

/// The lowest that a point on its way may be above the bound: between the heights of its nodes, which it leaves.
btScalar TouchSearch::lowestHeight(const ContactPatch& patch, const ShapeBound& bound) {
  btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    heights_[0][n] = bound(carriers_[n].now);
    heights_[1][n] = bound(carriers_[n].predicted);
    low = std::min({low, heights_[0][n], heights_[1][n]});
    high = std::max({high, heights_[0][n], heights_[1][n]});
  }
  return (low + high - patch.spread * (high - low)) * btScalar(0.5);
}

btScalar TouchSearch::searchPoints(const ContactPatch& patch) {
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
  chooseTouches(first);
  return clear;
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

/// Returns how far the point is from meeting anything.
btScalar TouchSearch::touch(const ContactPatch& patch, std::uint32_t point) {
  const NodePath path = pathOf(patch, point);
  const Meeting met = firstMet(*probe_, path, reach_);
  if (!(met.distance.distance < BT_LARGE_FLOAT)) return met.clear;
  const btVector3& normal = met.distance.normal;
  PointTouch touch;
  touch.distance = met.distance.distance - margin_ + normal.dot(path.now - met.where);
  touch.predicted = touch.distance + normal.dot(path.predicted - path.now);
  // What is too near is pushed out, wherever it goes.
  if (!(touch.predicted < speculation_ || touch.distance < speculation_)) return 0;
  touch.position = shape_.now * path.now;
  touch.normal = shape_.now.getBasis() * normal;
  touch.patch = static_cast<std::uint32_t>(&patch - patches_.patches.data());
  touch.point = patch.firstPoint + point;
  touches_.push_back(touch);
  return 0;
}

/// Of the patch's: the one that goes deepest, and then the ones farthest from those that are chosen. What was touched
/// in the step before has some lead, so that the choice does not change from step to step: what rests sticks to it.
void TouchSearch::chooseTouches(std::size_t first) {
  if (touches_.size() - first <= 2) return;
  const auto begin = touches_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto lead = [&](const PointTouch& touch) {
    const bool known = std::binary_search(memory_->touched.begin(), memory_->touched.end(), touch.point);
    return known ? kSpacing * slack_ : btScalar(0);
  };
  chosen_.clear();
  auto next = std::min_element(begin, touches_.end(), [&](const PointTouch& a, const PointTouch& b) {
    return a.predicted - lead(a) < b.predicted - lead(b);
  });
  apart_.assign(touches_.size() - first, BT_LARGE_FLOAT);
  // Lies or slides on a plane: where it falls onto one, points between those that are chosen go in.
  const bool flat = std::all_of(begin, touches_.end(), [&](const PointTouch& touch) {
    return touch.normal.dot(begin->normal) > kSamePlane && touch.distance - touch.predicted < kCalm * slack_;
  });
  const std::size_t few = first < kManyTouches ? kMinTouches : 2;
  const std::size_t enough = flat ? few : kMaxTouches;
  const auto enoughApart = [&] { return chosen_.size() < kMinTouches ? btScalar(0) : kSpacing * slack_; };
  for (;;) {
    chosen_.push_back(*next);
    if (chosen_.size() == enough) break;
    btScalar most = -BT_LARGE_FLOAT;
    for (auto at = begin; at != touches_.end(); ++at) {
      btScalar& apart = apart_[static_cast<std::size_t>(at - begin)];
      apart = std::min(apart, (at->position - chosen_.back().position).length());
      const btScalar gain = apart + lead(*at) - kDepthsWorth * at->predicted;
      if (apart <= enoughApart() || gain <= most) continue;
      most = gain;
      next = at;
    }
    if (!(most > -BT_LARGE_FLOAT)) break;
  }
  touches_.erase(begin, touches_.end());
  touches_.insert(touches_.end(), chosen_.begin(), chosen_.end());
}

}  // namespace tetskin
