// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: which samples of one body may be in which tets of another.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace tetskin::contact_detail {

/// How far samples may move before one of them is within a tet that was not, or at the surface; no more than that,
/// world space.
struct Clearance {
  double outside = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();  ///< of those within, from the surface; below 0 inside

  void cut(const Clearance& other) {
    outside = std::min(outside, other.outside);
    distance = std::min(distance, other.distance);
  }
};

/// Runs of samples of the first body, each with the tets of the second that it may be in.
class PairCandidates {
 public:
  /// Both read: a step has moved them.
  void advance(const ContactBody& first, const ContactBody& second);
  /// In the last step, as `advance` has it.
  btScalar moved() const { return static_cast<btScalar>(moved_); }
  /// Whether those found before are still all there are.
  bool hold() const { return path_ <= slack_; }

  /// Both read. `first` and `second` may be one body: then tets near to each other at rest are no candidates.
  /// slack  how far nodes may move against each other before it is to be done again, world space
  /// Cost   about O(number of runs and tets, and of candidates)
  void find(ContactBody& first, ContactBody& second, btScalar slack);

  /// Calls begin(run), then test(tet) for its tets, and end(run), for runs that have any, in ascending order. `test`
  /// returns a Clearance: it is not called again while bodies have moved too little to end it.
  template <class Begin, class Test, class End>
  void visit(btScalar reach, Begin&& begin, Test&& test, End&& end) {
    for (Run& of : runs_) {
      if (isClear(of.until, reach)) continue;
      begin(of.run);
      of.until = {};
      for (std::size_t c = of.first; c < of.last; ++c) {
        Link& link = links_[c];
        if (!isClear(link.until, reach)) {
          link.until = test(link.tet);
          link.until.outside += path_;
          link.until.distance += path_;
        }
        of.until.cut(link.until);
      }
      end(of.run);
    }
  }
  bool empty() const { return runs_.empty(); }

 private:
  struct Link {
    int run = 0, tet = 0;
    Clearance until{0, 0};  ///< of the path
  };
  struct Run {
    int run = 0;
    std::size_t first = 0, last = 0;  ///< in `links_`
    Clearance until{0, 0};            ///< the least of its links'
  };
  struct Pair {
    const ContactBody* first;
    ContactBody* second;
    ContactBox overlap;
    btScalar slack;
  };
  bool isClear(const Clearance& until, btScalar reach) const {
    return path_ < until.outside && path_ + static_cast<double>(reach) < until.distance;
  }
  void gatherRuns();
  void meetLeaves(const Pair& pair, const Bvh::Node& runs, const Bvh::Node& tets);

  btVector3 apart_{0, 0, 0};  ///< the bodies' centroids, when last looked at; and what nodes had travelled by then
  double travelled_ = 0;
  double path_ = 0;  ///< since candidates were found: no less than any two nodes of the bodies have moved to each other
  double moved_ = 0;  ///< of that, in the last step
  double slack_ = -1;
  std::vector<Run> runs_;
  std::vector<Link> links_;  ///< by run
};

}  // namespace tetskin::contact_detail
