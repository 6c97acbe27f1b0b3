// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {

void PairCandidates::advance(const ContactBody& first, const ContactBody& second) {
  const btVector3 apart = second.centroid - first.centroid;
  const double travelled = first.travelled + second.travelled;
  moved_ = travelled - travelled_ + static_cast<double>((apart - apart_).length());
  path_ += moved_;
  apart_ = apart;
  travelled_ = travelled;
}

void PairCandidates::find(ContactBody& first, ContactBody& second, btScalar slack) {
  first.fit();
  second.fit();
  apart_ = second.centroid - first.centroid;
  travelled_ = first.travelled + second.travelled;
  path_ = 0;
  slack_ = static_cast<double>(slack);
  runs_.clear();
  links_.clear();
  const SearchTree &runs = first.data().runTree, &tets = second.data().tetTree;
  if (runs.tree.empty() || tets.tree.empty()) return;
  const Pair pair{&first, &second, first.runTreeBoxes[0].grownBy(slack).intersection(second.tetTreeBoxes[0]), slack};
  const ContactBox near = pair.overlap.grownBy(slack);
  runs.visitLeaves([&](std::size_t node) { return first.runTreeBoxes[node].collides(near); },
                   [&](std::size_t node) { findInLeaf(pair, node); });
  std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.run < b.run; });
}

/// Finds the groups near to all runs of a leaf, and then those near to each.
void PairCandidates::findInLeaf(const Pair& pair, std::size_t leaf) {
  const SearchTree &runs = pair.first->data().runTree, &tets = pair.second->data().tetTree;
  const ContactBox around = pair.first->runTreeBoxes[leaf].grownBy(pair.slack).intersection(pair.overlap);
  groups_.clear();
  tets.visitLeaves([&](std::size_t node) { return pair.second->tetTreeBoxes[node].collides(around); },
                   [&](std::size_t node) { groups_.push_back(static_cast<std::size_t>(tets.leafOf[node])); });
  if (groups_.empty()) return;
  const Bvh::Node& node = runs.tree.nodes()[leaf];
  for (int k = node.first; k < node.last; ++k) findForRun(pair, runs.tree.item(k));
}

void PairCandidates::findForRun(const Pair& pair, int run) {
  const ContactBox around = pair.first->runBox(run);
  if (!around.grownBy(pair.slack).collides(pair.overlap)) return;
  static const std::vector<NearGroup> kNone;
  const bool same = pair.first == pair.second;
  const std::vector<NearGroup>& near = same ? pair.first->data().nearGroups[static_cast<std::size_t>(run)] : kNone;
  auto next = near.begin();
  Run found;
  found.run = run;
  found.first = links_.size();
  for (const std::size_t group : groups_) {
    const GroupBoxes& boxes = pair.second->groupBoxes[group];
    const Link far;
    if (gapsOf(far, boxes, around).least > pair.slack) continue;
    Link& link = links_.emplace_back();
    link.group = static_cast<int>(group);
    while (next != near.end() && next->group < link.group) ++next;
    if (next != near.end() && next->group == link.group) {
      for (std::size_t k = 0; k < kLanes; ++k) link.neighbour[k] = next->near[k] ? kForever : -kForever;
    }
    link.until = {gapsOf(link, boxes, around).least, kForever};
    if (link.until.outside > pair.slack) links_.pop_back();
  }
  found.last = links_.size();
  if (found.first == found.last) return;
  found.until = leastOf(found);
  runs_.push_back(found);
}

Clearance PairCandidates::leastOf(const Run& run) const {
  Clearance least;
  for (std::size_t c = run.first; c < run.last; ++c) least.cut(links_[c].until);
  return least;
}

/// Sets the clearance of those links whose boxes are apart from a box. Returns true if it is so for all.
bool PairCandidates::closeByBoxes(const Run& run, const ContactBody& second, const ContactBox& box, btScalar reach) {
  const auto path = static_cast<btScalar>(path_);
  bool all = true;
  for (std::size_t c = run.first; c < run.last; ++c) {
    Link& link = links_[c];
    if (isClear(link.until, path, reach)) continue;
    const btScalar gap = gapsOf(link, second.groupBoxes[static_cast<std::size_t>(link.group)], box).least;
    if (gap > 0) link.until = {path + gap, kForever};
    all = all && gap > 0;
  }
  return all;
}

}  // namespace tetskin::contact_detail
