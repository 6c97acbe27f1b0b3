// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: finds which samples of one body may be in which tets of another.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

namespace tetskin::contact_detail {

/// A lower bound of the distance by which samples may move before one of them enters a tet, or reaches the surface;
/// world space.
struct Clearance {
  double outside = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();  ///< from the surface, the least of the samples within the
                                                              ///< tet; below 0 inside

  void cut(const Clearance& other) {
    outside = std::min(outside, other.outside);
    distance = std::min(distance, other.distance);
  }
};

/// Runs of samples of the first body, each with the tets of the second that may contain samples.
class PairCandidates {
 public:
  /// Records the motion of a step. Both bodies have been read.
  void advance(const ContactBody& first, const ContactBody& second);
  /// The motion in the last step, as `advance` has recorded it.
  btScalar moved() const { return static_cast<btScalar>(moved_); }
  /// True if the candidates found before are still complete.
  bool hold() const { return path_ <= slack_; }

  /// Finds the candidates. Both bodies have been read. `first` and `second` may be the same body: then tets near to
  /// each other at rest are no candidates.
  /// slack  relative motion of nodes up to which the candidates stay complete, world space
  /// Cost   about O(number of runs and tets, and of candidates)
  void find(ContactBody& first, ContactBody& second, btScalar slack);

  /// Calls begin(run), then test(tet) for its tets, and end(run), for the runs that have candidates, in ascending
  /// order. `test` returns a Clearance: the tet is not tested again until the bodies have moved enough to exceed it.
  template <class Begin, class Test, class End>
  void visit(btScalar reach, Begin&& begin, Test&& test, End&& end) {
    assert(hold());
    for (Run& run : runs_) {
      if (isClear(run.until, reach)) continue;
      begin(run.run);
      run.until = {};
      for (std::size_t c = run.first; c < run.last; ++c) {
        Link& link = links_[c];
        if (!isClear(link.until, reach)) {
          link.until = test(link.tet);
          link.until.outside += path_;
          link.until.distance += path_;
        }
        run.until.cut(link.until);
      }
      end(run.run);
    }
  }
  bool empty() const { return runs_.empty(); }

 private:
  struct Link {
    int run = 0, tet = 0;
    Clearance until{0, 0};  ///< value of the path at which it ends
  };
  struct Run {
    int run = 0;
    std::size_t first = 0, last = 0;  ///< in `links_`
    Clearance until{0, 0};            ///< the least of its links' values
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
  void overlapLeaves(const Pair& pair, const Bvh::Node& runs, const Bvh::Node& tets);

  btVector3 apart_{0, 0,
                   0};  ///< difference of the bodies' centroids when last read, and the paths of their nodes until then
  double travelled_ = 0;
  double path_ = 0;   ///< bound of the relative motion of any two nodes since candidates were found
  double moved_ = 0;  ///< path of the last step
  double slack_ = -1;
  std::vector<Run> runs_;
  std::vector<Link> links_;  ///< sorted by run
};

}  // namespace tetskin::contact_detail
