// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/node_touches.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// In cubes of the grid: how much deeper another sample of a node must be than one that touched before. Without it, a
/// resting body is supported by other samples in each step, and jitters.
constexpr btScalar kKeptCubes = btScalar(0.1);
/// In mean edges: two samples of a node that are this far apart may both be contacts. At 2, which leaves one, light
/// parts swing between the two: in `tetskin_measure` soft stack/1 to 100 to 1 never rests (nodes at 0.01 of its size
/// per second, where 0.005 is promised); at 0.2, nodes of light corners in a bin of 100 cubes swing at 1 m/s.
constexpr btScalar kBesideEdges = btScalar(0.1);
/// Most contacts of a node beside the deepest one, in a direction. With 1, a light end in the heap of `tetskin_pile`
/// swings at 1 m/s on four samples.
constexpr std::size_t kMostBeside = 3;
/// Depth, in cubes of the grid, beyond which a further sample becomes a contact: one that others support does not sink.
/// With all of them, a bin of cubes comes to rest later.
constexpr btScalar kSunkCubes = btScalar(0.05);
/// Steps for which a sample is remembered that has touched: samples that take turns do so within fewer.
constexpr int kRememberedSteps = 16;
/// Cosine between normals from which on two contacts of a node count as one: a node in a fold is pushed several ways.
/// The soft scenes of `tetskin_measure`, which have no folds, hold with -1, too.
constexpr btScalar kOneWayCosine = btScalar(0.7);

bool isBefore(const TouchedSample& a, const TouchedSample& b) {
  return a.sample < b.sample;
}

}  // namespace

void NodeTouches::begin(const ContactBody& body, btScalar cube, std::vector<TouchedSample>& touched,
                        std::vector<Touch>& touches) {
  assert(cube > 0 && std::is_sorted(touched.begin(), touched.end(), isBefore));
  body_ = &body;
  cube_ = cube;
  touched_.swap(touched);
  touches_ = &touches;
  touches.clear();
  touchOfNode_.assign(body.data().nodes.size(), -1);
}

int NodeTouches::ageOf(int sample) const {
  const auto known = std::lower_bound(touched_.begin(), touched_.end(), TouchedSample{sample, 0}, isBefore);
  return known != touched_.end() && known->sample == sample ? known->age : -1;
}

/// Samples that touched in the step before count as deeper: otherwise a resting body would be supported by other
/// samples in each step, and jitter.
btScalar NodeTouches::rankOf(const Touch& touch) const {
  return ageOf(touch.sample) == 0 ? touch.distance - kKeptCubes * cube_ : touch.distance;
}

/// Of a node with samples on a long part, one may touch while others that have touched are held by that contact only:
/// were they not contacts, too, they would take turns, and the part would swing from step to step.
void NodeTouches::keep(const Touch& touch) {
  assert(body_);
  const int node = body_->data().sampleNodes[static_cast<std::size_t>(touch.sample)];
  assert(node >= 0 && static_cast<std::size_t>(node) < touchOfNode_.size());
  sameWay_.clear();
  for (int t = touchOfNode_[static_cast<std::size_t>(node)]; t >= 0; t = at(t).next) {
    if (at(t).normal.dot(touch.normal) >= kOneWayCosine) sameWay_.push_back(t);
  }
  if (sameWay_.empty()) return add(touch, node);
  const auto isDeeper = [this](int a, int b) { return rankOf(at(a)) < rankOf(at(b)); };
  std::swap(sameWay_.front(), *std::min_element(sameWay_.begin(), sameWay_.end(), isDeeper));
  Touch other = touch;  // the one that is not the deepest
  if (rankOf(touch) < rankOf(at(sameWay_.front()))) {
    other = at(sameWay_.front());
    replace(sameWay_.front(), touch);
  }
  if (ageOf(other.sample) >= 0) keepBeside(other, node);
}

/// Keeps a touch unless one nearby, or enough others, are deeper.
void NodeTouches::keepBeside(const Touch& touch, int node) {
  assert(!sameWay_.empty());
  const btScalar apart = kBesideEdges * body_->data().edge;
  const auto isNear = [&](int t) { return (touch.point - at(t).point).length2() <= apart * apart; };
  if (isNear(sameWay_.front())) return;
  auto rival = std::find_if(sameWay_.begin() + 1, sameWay_.end(), isNear);
  if (rival == sameWay_.end()) {
    // A sample that has touched in the step before would sink otherwise.
    const bool sinks = ageOf(touch.sample) == 0 || touch.distance < -kSunkCubes * cube_;
    if (sameWay_.size() <= (sinks ? kMostBeside : 1)) return add(touch, node);
    rival = std::max_element(sameWay_.begin() + 1, sameWay_.end(),
                             [this](int a, int b) { return rankOf(at(a)) < rankOf(at(b)); });
  }
  if (rankOf(touch) < rankOf(at(*rival))) replace(*rival, touch);
}

void NodeTouches::replace(int index, const Touch& by) {
  const int next = at(index).next;
  at(index) = by;
  at(index).next = next;
}

void NodeTouches::add(const Touch& touch, int node) {
  int& head = touchOfNode_[static_cast<std::size_t>(node)];
  touches_->push_back(touch);
  touches_->back().next = head;
  head = static_cast<int>(touches_->size()) - 1;
}

/// A node that touches nothing in this step keeps the samples with which it touched before.
void NodeTouches::remember(std::vector<TouchedSample>& touched) {
  assert(body_);
  touched.clear();
  for (const Touch& touch : *touches_) touched.push_back({touch.sample, 0});
  std::sort(touched.begin(), touched.end(), isBefore);
  const auto now = static_cast<std::ptrdiff_t>(touched.size());
  const std::vector<int>& nodes = body_->data().sampleNodes;
  for (const TouchedSample& known : touched_) {
    if (std::binary_search(touched.begin(), touched.begin() + now, known, isBefore)) continue;
    const int node = nodes[static_cast<std::size_t>(known.sample)];
    const int age = known.age + (touchOfNode_[static_cast<std::size_t>(node)] < 0 ? 0 : 1);
    if (age < kRememberedSteps) touched.push_back({known.sample, age});
  }
  std::inplace_merge(touched.begin(), touched.begin() + now, touched.end(), isBefore);
  body_ = nullptr;
}

}  // namespace tetskin::contact_detail
