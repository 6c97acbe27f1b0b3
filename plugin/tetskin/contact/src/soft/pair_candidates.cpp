// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_candidates.h>
#include <tetskin/contact/src/soft/rigid_motion.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
void PairCandidates::update(ContactBody& first, ContactBody& second, btScalar dt) {
  assert(dt > 0 && first.reads > 0 && second.reads > 0);
  const bool again = first.reads == reads_[0] && second.reads == reads_[1];
  if (!again && !follow(first, second)) find(first, second);
  if (!again) setReach(first, second, dt);
  reads_[0] = first.reads;
  reads_[1] = second.reads;
}

/// Returns false if the candidates may no longer be complete.
bool PairCandidates::follow(const ContactBody& first, const ContactBody& second) {
  if (first.reads != reads_[0] + 1 || second.reads != reads_[1] + 1) return false;
  if (!validity_.lasts(first, second)) return false;
  const btScalar all = accountable(first.data().largestSpread * first.moved + kInsideSpread * second.moved, second);
  if (all <= kStillCubes * second.data().grid.spacing()) {
    for (Run& run : runs_) run.path += all;
    return true;
  }
  const auto before = [](const ContactBody& body) { return [&](std::size_t n) { return body.before[n]; }; };
  const auto now = [](const ContactBody& body) { return [&](std::size_t n) { return body.positions[n]; }; };
  measure(first, before(first), now(first), second, before(second), now(second),
          [&](Run& run, btScalar motion) { run.path += accountable(motion, second); });
  return true;
}

/// Calls use(run, bound) for each run, with a bound of how much the run's samples and the tets near them approach each
/// other while nodes go from one position to another.
/// from, to            btVector3(std::size_t node), of the first body
/// fromOther, toOther  of the second one
template <class From, class To, class FromOther, class ToOther, class Use>
void PairCandidates::measure(const ContactBody& firstBody, const From& from, const To& to,
                             const ContactBody& secondBody, const FromOther& fromOther, const ToOther& toOther,
                             Use&& use) {
  if (runs_.empty()) return;
  const RigidMotion motion(nodes_[1], fromOther, toOther);
  for (const int node : nodes_[0]) {
    const auto n = static_cast<std::size_t>(node);
    nodeMotion_[n] = (to(n) - motion(from(n))).length2();
  }
  btScalar second = 0;
  for (const int node : nodes_[1]) {
    const auto n = static_cast<std::size_t>(node);
    second = std::max(second, (toOther(n) - motion(fromOther(n))).length2());
  }
  const ShapeData& shape = firstBody.data();
  const btScalar other = kInsideSpread * btSqrt(second) + roundingOf(firstBody, secondBody);
  for (Run& run : runs_) {
    const auto r = static_cast<std::size_t>(run.run);
    btScalar own = 0;
    for (const int n : shape.tets[static_cast<std::size_t>(shape.runs[r].tet)]) {
      own = std::max(own, nodeMotion_[static_cast<std::size_t>(n)]);
    }
    use(run, shape.runRegions[r].spread() * btSqrt(own) + other);
  }
}

void PairCandidates::setReach(const ContactBody& first, const ContactBody& second, btScalar dt) {
  const btScalar cube = second.data().grid.spacing();
  const auto set = [&](Run& run, btScalar motion) {
    run.reach = std::min(kReachCubes * cube, kNearCubes * cube + motion);
  };
  const btScalar all =
      accountable(dt * (first.data().largestSpread * first.fastest + kInsideSpread * second.fastest), second);
  if (all <= kStillCubes * cube) {
    for (Run& run : runs_) set(run, all);
    return;
  }
  const auto now = [](const ContactBody& body) { return [&](std::size_t n) { return body.positions[n]; }; };
  const auto next = [dt](const ContactBody& body) {
    return [&body, dt](std::size_t n) { return body.positions[n] + dt * body.velocities[n]; };
  };
  measure(first, now(first), next(first), second, now(second), next(second), set);
}

void PairCandidates::find(ContactBody& first, ContactBody& second) {
  first.fit();
  second.fit();
  validity_.begin(first, second);
  runs_.clear();
  links_.clear();
  lanes_.clear();
  const SearchTree &runs = first.data().runTree, &tets = second.data().tetTree;
  if (runs.tree.empty() || tets.tree.empty()) return;
  const Pair pair{&first, &second,
                  first.runTreeBoxes[0].grownBy(validity_.slack()).intersection(second.tetTreeBoxes[0])};
  const ContactBox near = pair.overlap.grownBy(validity_.slack());
  runs.visitLeaves([&](std::size_t node) { return first.runTreeBoxes[node].collides(near); },
                   [&](std::size_t node) { findInLeaf(pair, node); });
  std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.run < b.run; });
  std::size_t samples = 0;
  for (Run& run : runs_) {
    run.samples = samples;
    const SampleRun& carried = first.data().runs[static_cast<std::size_t>(run.run)];
    samples += static_cast<std::size_t>(carried.last - carried.first);
  }
  samples_.assign(samples, {});
  listNodes(first, second);
}

/// Finds the groups near to all runs of a leaf, and then those near to each run.
void PairCandidates::findInLeaf(const Pair& pair, std::size_t leaf) {
  const SearchTree &runs = pair.first->data().runTree, &tets = pair.second->data().tetTree;
  const ContactBox around = pair.first->runTreeBoxes[leaf].grownBy(validity_.slack()).intersection(pair.overlap);
  groups_.clear();
  tets.visitLeaves([&](std::size_t node) { return pair.second->tetTreeBoxes[node].collides(around); },
                   [&](std::size_t node) { groups_.push_back(static_cast<std::size_t>(tets.leafOf[node])); });
  if (groups_.empty()) return;
  const Bvh::Node& node = runs.tree.nodes()[leaf];
  for (int k = node.first; k < node.last; ++k) findForRun(pair, runs.tree.item(k));
}

void PairCandidates::findForRun(const Pair& pair, int run) {
  const ContactBox around = pair.first->runBox(run);
  if (!around.grownBy(validity_.slack()).collides(pair.overlap)) return;
  static const std::vector<NearGroup> kNone;
  const bool same = pair.first == pair.second;
  const std::vector<NearGroup>& near = same ? pair.first->data().nearGroups[static_cast<std::size_t>(run)] : kNone;
  auto next = near.begin();
  const FourBoxes boxes(around);
  Run found;
  found.run = run;
  found.first = links_.size();
  for (const std::size_t group : groups_) {
    const GroupBoxes& tets = pair.second->groupBoxes[group];
    btScalar gap = least(gapsBetween(boxes, tets));
    if (gap > validity_.slack()) continue;
    Link link;
    link.group = static_cast<int>(group);
    while (next != near.end() && next->group < link.group) ++next;
    if (next != near.end() && next->group == link.group) {
      for (unsigned k = 0; k < kLanes; ++k) link.neighbours |= next->near[k] ? 1U << k : 0U;
      gap = least(gapsOf(link.neighbours, tets, boxes));
      if (gap > validity_.slack()) continue;
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

}  // namespace tetskin::contact_detail
