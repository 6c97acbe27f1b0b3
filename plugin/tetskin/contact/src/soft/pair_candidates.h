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

/// Infinite: a clearance that no motion exceeds.
constexpr btScalar kForever = std::numeric_limits<btScalar>::infinity();

/// A lower bound of the distance by which samples may move before one of them enters a tet, or reaches the surface;
/// world space.
struct Clearance {
  btScalar outside = kForever;
  btScalar distance = kForever;  ///< from the surface, the least of the samples within the tet; below 0 inside

  void cut(const Clearance& other) {
    outside = std::min(outside, other.outside);
    distance = std::min(distance, other.distance);
  }
};

/// Runs of samples of the first body, each with the groups of tets of the second that may contain samples.
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

  /// Visits the runs that may have samples in tets, in ascending order: calls begin(run), which returns the box around
  /// its samples, then test(tet) for the tets whose boxes overlap it, in the order of the tree, and end(run). `test`
  /// returns a Clearance: the tet is not tested again until the bodies have moved enough to exceed it.
  template <class Begin, class Test, class End>
  void visit(const ContactBody& first, const ContactBody& second, btScalar reach, Begin&& begin, Test&& test,
             End&& end);
  bool empty() const { return runs_.empty(); }

 private:
  /// A group of tets that may contain samples of a run, and the values of the path at which clearances end.
  struct Link {
    int group = 0;
    Clearance until{0, 0};                                      ///< of the whole group
    Clearance ends[kLanes] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};  ///< by lane; may end later than that of the group
    /// Infinite for tets that are no candidates, below all gaps for others.
    btScalar neighbour[kLanes] = {-kForever, -kForever, -kForever, -kForever};
  };
  struct Run {
    int run = 0;
    std::size_t first = 0, last = 0;  ///< in `links_`
    Clearance until{0, 0};            ///< the least of its links' values
  };
  /// The distances between a box and those of a group, and the least of them; 0 or below if they overlap.
  struct Gaps {
    btScalar gap[kLanes], least;
  };
  struct Pair {
    const ContactBody* first;
    const ContactBody* second;
    ContactBox overlap;
    btScalar slack;
  };
  void findInLeaf(const Pair& pair, std::size_t leaf);
  void findForRun(const Pair& pair, int run);
  Clearance leastOf(const Run& run) const;
  static Gaps gapsOf(const Link& link, const GroupBoxes& boxes, const ContactBox& box);
  bool closeByBoxes(const Run& run, const ContactBody& second, const ContactBox& box, btScalar reach);
  template <class Test>
  void testLink(Link& link, const ContactBody& second, const ContactBox& box, btScalar reach, Test& test) const;
  static bool isClear(const Clearance& until, btScalar path, btScalar reach) {
    return path < until.outside && path + reach < until.distance;
  }

  /// Difference of the bodies' centroids when last read, and the paths of their nodes until then.
  btVector3 apart_{0, 0, 0};
  double travelled_ = 0;
  double path_ = 0;   ///< bound of the relative motion of any two nodes since candidates were found
  double moved_ = 0;  ///< path of the last step
  double slack_ = -1;
  std::vector<Run> runs_;
  std::vector<Link> links_;          ///< by run
  std::vector<std::size_t> groups_;  ///< found for a leaf of runs
};

/// Written so that compilers compute the lanes side by side.
inline PairCandidates::Gaps PairCandidates::gapsOf(const Link& link, const GroupBoxes& boxes, const ContactBox& box) {
  const auto larger = [](btScalar a, btScalar b) { return a > b ? a : b; };
  Gaps gaps;
  for (int k = 0; k < kLanes; ++k) {
    const btScalar x = larger(box.low[0] - boxes.high[0][k], boxes.low[0][k] - box.high[0]);
    const btScalar y = larger(box.low[1] - boxes.high[1][k], boxes.low[1][k] - box.high[1]);
    const btScalar z = larger(box.low[2] - boxes.high[2][k], boxes.low[2][k] - box.high[2]);
    gaps.gap[k] = larger(larger(x, y), larger(z, link.neighbour[k]));
  }
  static_assert(kLanes == 4, "one comparison for each lane");
  gaps.least = std::min(std::min(gaps.gap[0], gaps.gap[1]), std::min(gaps.gap[2], gaps.gap[3]));
  return gaps;
}

template <class Test>
void PairCandidates::testLink(Link& link, const ContactBody& second, const ContactBox& box, btScalar reach,
                              Test& test) const {
  const auto path = static_cast<btScalar>(path_);
  const auto g = static_cast<std::size_t>(link.group);
  const Gaps gaps = gapsOf(link, second.groupBoxes[g], box);
  link.until = {path + gaps.least, kForever};
  if (gaps.least > 0) return;
  link.until = {};
  for (std::size_t k = 0; k < kLanes; ++k) {
    Clearance& ends = link.ends[k];
    if (gaps.gap[k] > 0) {
      ends = {path + gaps.gap[k], kForever};
    } else if (!isClear(ends, path, reach)) {
      const Clearance found = test(second.data().groups[g][k]);
      ends = {path + found.outside, path + found.distance};
    }
    link.until.cut(ends);
  }
}

template <class Begin, class Test, class End>
void PairCandidates::visit(const ContactBody& first, const ContactBody& second, btScalar reach, Begin&& begin,
                           Test&& test, End&& end) {
  assert(hold());
  const auto path = static_cast<btScalar>(path_);
  for (Run& run : runs_) {
    if (isClear(run.until, path, reach)) continue;
    if (!closeByBoxes(run, second, first.runBox(run.run), reach)) {
      const ContactBox box = begin(run.run);
      for (std::size_t c = run.first; c < run.last; ++c) {
        if (!isClear(links_[c].until, path, reach)) testLink(links_[c], second, box, reach, test);
      }
      end(run.run);
    }
    run.until = leastOf(run);
  }
}

}  // namespace tetskin::contact_detail
