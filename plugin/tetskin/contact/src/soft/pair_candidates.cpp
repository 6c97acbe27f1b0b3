// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::contact_detail {
namespace {

/// Relative motion of the bodies up to which candidates stay complete: that of this many steps, in cubes of the grid
/// bounded as given.
constexpr btScalar kSlackSteps = 6, kSlackCubes = btScalar(0.7), kMaxSlackCubes = 3;

/// The largest length of a vector after `shift` has been subtracted.
btScalar largestMotion(const std::vector<btVector3>& to, const std::vector<btVector3>& from, const btVector3& shift) {
  assert(to.size() == from.size());
  btScalar squared = 0;
  for (std::size_t n = 0; n < to.size(); ++n) squared = std::max(squared, (to[n] - from[n] - shift).length2());
  return btSqrt(squared);
}

template <class Value>
btVector3 meanOf(const std::vector<int>& nodes, const Value& value) {
  assert(!nodes.empty());
  btVector3 sum(0, 0, 0);
  for (const int n : nodes) sum += value(static_cast<std::size_t>(n));
  return sum / static_cast<btScalar>(nodes.size());
}

}  // namespace

void PairCandidates::update(ContactBody& first, ContactBody& second, btScalar dt) {
  assert(dt > 0 && first.reads > 0 && second.reads > 0);
  const bool again = first.reads == reads_[0] && second.reads == reads_[1];
  if (!again && !follow(first, second)) find(first, second);
  if (!again) setReach(first, second, dt);
  reads_[0] = first.reads;
  reads_[1] = second.reads;
}

/// Returns false if the candidates may not be complete any more.
bool PairCandidates::follow(const ContactBody& first, const ContactBody& second) {
  if (first.reads != reads_[0] + 1 || second.reads != reads_[1] + 1) return false;
  ++age_;
  drift_ = driftOf(first, second);
  if (!(drift_ <= slack_)) return false;
  measure(
      first, [&](std::size_t n) { return first.positions[n] - first.before[n]; },
      [&](std::size_t n) { return second.positions[n] - second.before[n]; },
      [](Run& run, btScalar motion) { run.path += motion; });
  return true;
}

/// Measured from the positions when candidates were found, so that what swings to and fro stays near them. A
/// translation that both share does not count.
btScalar PairCandidates::driftOf(const ContactBody& first, const ContactBody& second) const {
  const btVector3 shift = (first.centroid - centroids_[0] + second.centroid - centroids_[1]) / 2;
  return first.data().largestSpread * largestMotion(first.positions, found_[0], shift) +
         largestMotion(second.positions, found_[1], shift);
}

/// Calls use(run, bound) for each run, with a bound of the differences between a vector that belongs to a node and
/// moves with it (its motion, its velocity) at the run's samples and at the tets near them.
template <class OfFirst, class OfSecond, class Use>
void PairCandidates::measure(const ContactBody& first, const OfFirst& ofFirst, const OfSecond& ofSecond, Use&& use) {
  if (runs_.empty()) return;
  const btVector3 mean = (meanOf(nodes_[0], ofFirst) + meanOf(nodes_[1], ofSecond)) / 2;
  for (const int n : nodes_[0]) {
    nodeMotion_[static_cast<std::size_t>(n)] = (ofFirst(static_cast<std::size_t>(n)) - mean).length2();
  }
  btScalar second = 0;
  for (const int n : nodes_[1]) second = std::max(second, (ofSecond(static_cast<std::size_t>(n)) - mean).length2());
  second = btSqrt(second);
  const ShapeData& shape = first.data();
  for (Run& run : runs_) {
    const auto r = static_cast<std::size_t>(run.run);
    btScalar own = 0;
    for (const int n : shape.tets[static_cast<std::size_t>(shape.runs[r].tet)]) {
      own = std::max(own, nodeMotion_[static_cast<std::size_t>(n)]);
    }
    use(run, shape.runParts[r].spread() * btSqrt(own) + second);
  }
}

void PairCandidates::setReach(const ContactBody& first, const ContactBody& second, btScalar dt) {
  const btScalar cube = second.data().grid.spacing();
  measure(
      first, [&](std::size_t n) { return first.velocities[n]; }, [&](std::size_t n) { return second.velocities[n]; },
      [&](Run& run, btScalar speed) { run.reach = std::min(kReachCubes * cube, kNearCubes * cube + dt * speed); });
}

void PairCandidates::find(ContactBody& first, ContactBody& second) {
  first.fit();
  second.fit();
  const btScalar cube = second.data().grid.spacing();
  const btScalar growth = age_ > 0 ? drift_ / static_cast<btScalar>(age_) : 0;
  slack_ = std::min(std::max(kSlackCubes * cube, kSlackSteps * growth), kMaxSlackCubes * cube);
  age_ = 0;
  found_[0] = first.positions;
  found_[1] = second.positions;
  centroids_[0] = first.centroid;
  centroids_[1] = second.centroid;
  runs_.clear();
  links_.clear();
  lanes_.clear();
  const SearchTree &runs = first.data().runTree, &tets = second.data().tetTree;
  if (runs.tree.empty() || tets.tree.empty()) return;
  const Pair pair{&first, &second, first.runTreeBoxes[0].grownBy(slack_).intersection(second.tetTreeBoxes[0])};
  const ContactBox near = pair.overlap.grownBy(slack_);
  runs.visitLeaves([&](std::size_t node) { return first.runTreeBoxes[node].collides(near); },
                   [&](std::size_t node) { findInLeaf(pair, node); });
  std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.run < b.run; });
  listNodes(first, second);
}

/// Finds the groups near to all runs of a leaf, and then those near to each.
void PairCandidates::findInLeaf(const Pair& pair, std::size_t leaf) {
  const SearchTree &runs = pair.first->data().runTree, &tets = pair.second->data().tetTree;
  const ContactBox around = pair.first->runTreeBoxes[leaf].grownBy(slack_).intersection(pair.overlap);
  groups_.clear();
  tets.visitLeaves([&](std::size_t node) { return pair.second->tetTreeBoxes[node].collides(around); },
                   [&](std::size_t node) { groups_.push_back(static_cast<std::size_t>(tets.leafOf[node])); });
  if (groups_.empty()) return;
  const Bvh::Node& node = runs.tree.nodes()[leaf];
  for (int k = node.first; k < node.last; ++k) findForRun(pair, runs.tree.item(k));
}

void PairCandidates::findForRun(const Pair& pair, int run) {
  const ContactBox around = pair.first->runBox(run);
  if (!around.grownBy(slack_).collides(pair.overlap)) return;
  static const std::vector<NearGroup> kNone;
  const bool same = pair.first == pair.second;
  const std::vector<NearGroup>& near = same ? pair.first->data().nearGroups[static_cast<std::size_t>(run)] : kNone;
  auto next = near.begin();
  Run found;
  found.run = run;
  found.first = links_.size();
  for (const std::size_t group : groups_) {
    const GroupBoxes& boxes = pair.second->groupBoxes[group];
    btScalar gap = gapsOf(0, boxes, around).least;
    if (gap > slack_) continue;
    Link link;
    link.group = static_cast<int>(group);
    while (next != near.end() && next->group < link.group) ++next;
    if (next != near.end() && next->group == link.group) {
      for (unsigned k = 0; k < kLanes; ++k) link.neighbours |= next->near[k] ? 1U << k : 0U;
      gap = gapsOf(link.neighbours, boxes, around).least;
      if (gap > slack_) continue;
    }
    link.until = {gap, kForever};
    found.until.outside = links_.size() == found.first ? gap : std::min(found.until.outside, gap);
    links_.push_back(link);
  }
  found.last = links_.size();
  if (found.first == found.last) return;
  found.until.distance = kForever;
  runs_.push_back(found);
}

/// Lists the nodes whose motion is measured.
void PairCandidates::listNodes(const ContactBody& first, const ContactBody& second) {
  const auto list = [](const ContactBody& body, std::vector<int>& nodes, const auto& forEachTet) {
    std::vector<char> listed(body.positions.size(), 0);
    nodes.clear();
    forEachTet([&](int tet) {
      for (const int n : body.data().tets[static_cast<std::size_t>(tet)]) {
        if (!listed[static_cast<std::size_t>(n)]) nodes.push_back(n);
        listed[static_cast<std::size_t>(n)] = 1;
      }
    });
  };
  list(first, nodes_[0], [&](const auto& add) {
    for (const Run& run : runs_) add(first.data().runs[static_cast<std::size_t>(run.run)].tet);
  });
  list(second, nodes_[1], [&](const auto& add) {
    std::vector<char> listed(second.data().groups.size(), 0);
    for (const Link& link : links_) {
      char& done = listed[static_cast<std::size_t>(link.group)];
      if (done) continue;
      done = 1;
      for (const int tet : second.data().groups[static_cast<std::size_t>(link.group)]) {
        if (tet >= 0) add(tet);
      }
    }
  });
  nodeMotion_.resize(first.positions.size());
}

Clearance PairCandidates::leastOf(const Run& run) const {
  Clearance least;
  for (std::size_t c = run.first; c < run.last; ++c) least.cut(links_[c].until);
  return least;
}

/// Sets the clearance of links whose boxes are apart from a box, up to the first one whose boxes are not. Returns true
/// if all are.
bool PairCandidates::closeByBoxes(const Run& run, const ContactBody& second, const ContactBox& box) {
  for (std::size_t c = run.first; c < run.last; ++c) {
    Link& link = links_[c];
    if (isClear(link.until, run)) continue;
    const btScalar gap = gapsOf(link.neighbours, second.groupBoxes[static_cast<std::size_t>(link.group)], box).least;
    if (!(gap > 0)) return false;
    link.until = {run.path + gap, kForever};
  }
  return true;
}

}  // namespace tetskin::contact_detail
