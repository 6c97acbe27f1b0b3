// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/other_parts.h>
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <algorithm>

namespace tetskin::contact_detail {
namespace {

/// And by way of the body.
bool nearAtRest(const ShapeData& data, int run, int tet) {
  const btVector3& a = data.middles[static_cast<std::size_t>(data.runs[static_cast<std::size_t>(run)].tet)];
  const btScalar apart = kEdgesApart * data.edge;
  if (!((a - data.middles[static_cast<std::size_t>(tet)]).length2() < apart * apart)) return false;
  const std::vector<int>& others = data.otherParts[static_cast<std::size_t>(run)];
  return !std::binary_search(others.begin(), others.end(), tet);
}

}  // namespace

bool PairCandidates::hold(const ContactBody& first, const ContactBody& second) const {
  const btVector3 moved = second.middle - first.middle - apart_;
  return first.travelled + second.travelled - travelled_ + static_cast<double>(moved.length()) <= slack_;
}

void PairCandidates::find(ContactBody& first, ContactBody& second, btScalar slack) {
  first.fit();
  second.fit();
  apart_ = second.middle - first.middle;
  travelled_ = first.travelled + second.travelled;
  slack_ = static_cast<double>(slack);
  for (const int run : runs_) heads_[static_cast<std::size_t>(run)] = -1;
  runs_.clear();
  links_.clear();
  heads_.resize(first.data().runs.size(), -1);
  if (first.runTree.empty() || second.tetTree.empty()) return;
  const ContactBox overlap = first.runTree.box(0).grownBy(slack).cutBy(second.tetTree.box(0));
  descend({&first, &second, overlap, slack}, 0, 0);
  std::sort(runs_.begin(), runs_.end());
}

void PairCandidates::descend(const Pair& pair, int firstNode, int secondNode) {
  const FittedTree &firstTree = pair.first->runTree, &secondTree = pair.second->tetTree;
  const ContactBox a = firstTree.box(firstNode).grownBy(pair.slack);
  const ContactBox& b = secondTree.box(secondNode);
  if (!a.meets(b) || !a.meets(pair.overlap) || !b.meets(pair.overlap)) return;
  const BoxTree::Node& first = firstTree.tree().nodes()[static_cast<std::size_t>(firstNode)];
  const BoxTree::Node& second = secondTree.tree().nodes()[static_cast<std::size_t>(secondNode)];
  if (first.right == 0 && second.right == 0) return meetLeaves(pair, first, second);
  // The one of more items is split.
  if (second.right == 0 || (first.right != 0 && first.last - first.first > second.last - second.first)) {
    descend(pair, firstNode + 1, secondNode);
    descend(pair, first.right, secondNode);
  } else {
    descend(pair, firstNode, secondNode + 1);
    descend(pair, firstNode, second.right);
  }
}

void PairCandidates::meetLeaves(const Pair& pair, const BoxTree::Node& a, const BoxTree::Node& b) {
  const FittedTree &runs = pair.first->runTree, &tets = pair.second->tetTree;
  const bool same = pair.first == pair.second;
  for (int i = a.first; i < a.last; ++i) {
    const ContactBox around = runs.itemBox(i).grownBy(pair.slack);
    if (!around.meets(pair.overlap)) continue;
    const int run = runs.tree().items()[static_cast<std::size_t>(i)];
    for (int j = b.first; j < b.last; ++j) {
      if (!around.meets(tets.itemBox(j))) continue;
      const int tet = tets.tree().items()[static_cast<std::size_t>(j)];
      // Whatever nodes move by until candidates are found anew is in the box's slack.
      const DeformedTet& deformed = pair.second->deformed(tet);
      if (!deformed.flat && isOutside(around, deformed)) continue;
      if (!same || !nearAtRest(pair.first->data(), run, tet)) add(run, tet);
    }
  }
}

void PairCandidates::add(int run, int tet) {
  int& head = heads_[static_cast<std::size_t>(run)];
  if (head < 0) runs_.push_back(run);
  links_.push_back({tet, head});
  head = static_cast<int>(links_.size()) - 1;
}

}  // namespace tetskin::contact_detail
