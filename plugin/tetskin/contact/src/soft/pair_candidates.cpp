// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/other_components.h>
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// True if a run and a tet are near at rest, both in space and along the body.
bool nearAtRest(const ShapeData& data, int run, int tet) {
  assert(data.otherComponents.size() == data.runs.size() && data.centroids.size() == data.tets.size());
  const btVector3& a = data.centroids[static_cast<std::size_t>(data.runs[static_cast<std::size_t>(run)].tet)];
  const btScalar apart = kEdgesApart * data.edge;
  if (!((a - data.centroids[static_cast<std::size_t>(tet)]).length2() < apart * apart)) return false;
  const std::vector<int>& others = data.otherComponents[static_cast<std::size_t>(run)];
  return !std::binary_search(others.begin(), others.end(), tet);
}

}  // namespace

void PairCandidates::advance(const ContactBody& first, const ContactBody& second) {
  const btVector3 apart = second.centroid - first.centroid;
  const double travelled = first.travelled + second.travelled;
  moved_ = travelled - travelled_ + static_cast<double>((apart - apart_).length());
  path_ += moved_;
  apart_ = apart;
  travelled_ = travelled;
}

void PairCandidates::find(ContactBody& first, ContactBody& second, btScalar slack) {
  assert(first.readable && second.readable && slack >= 0);
  first.fit();
  second.fit();
  apart_ = second.centroid - first.centroid;
  travelled_ = first.travelled + second.travelled;
  path_ = 0;
  slack_ = static_cast<double>(slack);
  runs_.clear();
  links_.clear();
  const Bvh &runs = first.data().runTree, &tets = second.data().tetTree;
  if (runs.empty() || tets.empty()) return;
  const std::vector<ContactBox>&runBoxes = first.runTreeBoxes, &tetBoxes = second.tetTreeBoxes;
  const ContactBox overlap = runBoxes[0].grownBy(slack).intersection(tetBoxes[0]);
  const auto meet = [&](int run, int tet) {
    const ContactBox a = runBoxes[static_cast<std::size_t>(run)].grownBy(slack);
    const ContactBox& b = tetBoxes[static_cast<std::size_t>(tet)];
    return a.collides(b) && a.collides(overlap) && b.collides(overlap);
  };
  const Pair pair{&first, &second, overlap, slack};
  visitPairs(runs, tets, meet, [&](const Bvh::Node& a, const Bvh::Node& b) { overlapLeaves(pair, a, b); });
  gatherRuns();
}

void PairCandidates::overlapLeaves(const Pair& pair, const Bvh::Node& runs, const Bvh::Node& tets) {
  const ShapeData &first = pair.first->data(), &second = pair.second->data();
  const bool same = pair.first == pair.second;
  for (int i = runs.first; i < runs.last; ++i) {
    const int run = first.runTree.item(i);
    const ContactBox around = pair.first->runBox(run).grownBy(pair.slack);
    if (!around.collides(pair.overlap)) continue;
    for (int j = tets.first; j < tets.last; ++j) {
      const int tet = second.tetTree.item(j);
      if (!around.collides(pair.second->tetBox(tet))) continue;
      // The box's slack covers all motion of nodes until candidates are found again.
      const DeformedTet& deformed = pair.second->deformed(tet);
      if (!deformed.flat && gapTo(around, deformed) > 0) continue;
      if (!same || !nearAtRest(first, run, tet)) links_.push_back({run, tet});
    }
  }
}

void PairCandidates::gatherRuns() {
  std::stable_sort(links_.begin(), links_.end(), [](const Link& a, const Link& b) { return a.run < b.run; });
  for (std::size_t c = 0; c < links_.size(); ++c) {
    if (c == 0 || links_[c].run != links_[c - 1].run) runs_.push_back({links_[c].run, c, c});
    runs_.back().last = c + 1;
  }
}

}  // namespace tetskin::contact_detail
