// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: which samples of one body may be in which tets of another.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <vector>

namespace tetskin::contact_detail {

/// By run of samples of the first body: tets of the second whose box meets the run's.
class PairCandidates {
 public:
  /// Whether those found before are still all there are.
  bool hold(const ContactBody& first, const ContactBody& second) const;

  /// Both read. `first` and `second` may be one body: then tets near to each other at rest are no candidates.
  /// slack  how far nodes may move against each other before it is to be done again, world space
  /// Cost   about O(number of runs and tets, and of candidates)
  void find(ContactBody& first, ContactBody& second, btScalar slack);

  /// Runs that have any, ascending.
  const std::vector<int>& runs() const { return runs_; }
  template <class Take>
  void forEachTet(int run, Take&& take) const {
    for (int c = heads_[static_cast<std::size_t>(run)]; c >= 0; c = links_[static_cast<std::size_t>(c)].next) {
      take(links_[static_cast<std::size_t>(c)].tet);
    }
  }

 private:
  struct Link {
    int tet = 0, next = -1;
  };
  struct Pair {
    const ContactBody* first;
    ContactBody* second;
    ContactBox overlap;
    btScalar slack;
  };
  void meetLeaves(const Pair& pair, const Bvh::Node& runs, const Bvh::Node& tets);
  void add(int run, int tet);

  btVector3 apart_{0, 0, 0};  ///< the bodies' middles, when it was done; and what nodes had travelled by then
  double travelled_ = 0;
  double slack_ = -1;
  std::vector<int> runs_, heads_;
  std::vector<Link> links_;
};

}  // namespace tetskin::contact_detail
