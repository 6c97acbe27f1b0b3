// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <algorithm>

namespace tetskin::contact_detail {
namespace {

bool nearAtRest(const ShapeData& data, int run, int tet) {
  const btVector3& a = data.middles[static_cast<std::size_t>(data.runs[static_cast<std::size_t>(run)].tet)];
  const btScalar apart = kEdgesApart * data.edge;
  return (a - data.middles[static_cast<std::size_t>(tet)]).length2() < apart * apart;
}

}  // namespace

void PairCandidates::find(const ContactBody& first, const ContactBody& second) {
  for (const int run : runs_) heads_[static_cast<std::size_t>(run)] = -1;
  runs_.clear();
  links_.clear();
  heads_.resize(std::max(heads_.size(), first.data().runs.size()), -1);
  if (first.runTree.empty() || second.tetTree.empty()) return;
  descend({&first, &second, first.box.cutBy(second.box)}, 0, 0);
  std::sort(runs_.begin(), runs_.end());
}

void PairCandidates::descend(const Pair& pair, int firstNode, int secondNode) {
  const FittedTree &firstTree = pair.first->runTree, &secondTree = pair.second->tetTree;
  const ContactBox &a = firstTree.box(firstNode), &b = secondTree.box(secondNode);
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
    if (!runs.itemBox(i).meets(pair.overlap)) continue;
    const int run = runs.tree().items()[static_cast<std::size_t>(i)];
    for (int j = b.first; j < b.last; ++j) {
      if (!runs.itemBox(i).meets(tets.itemBox(j))) continue;
      const int tet = tets.tree().items()[static_cast<std::size_t>(j)];
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
