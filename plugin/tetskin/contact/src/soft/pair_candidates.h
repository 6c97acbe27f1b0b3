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
  /// A group of tets that may contain samples of a run, and by lane, the values of the path at which its clearance
  /// ends.
  struct Link {
    int group = 0;
    btScalar outside[kLanes], distance[kLanes];
  };
  struct Run {
    int run = 0;
    std::size_t first = 0, last = 0;  ///< in `links_`
    Clearance until{0, 0};            ///< the least of its links' values
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
  template <class Test>
  void testOpen(Link& link, const TetGroup& tets, const bool (&open)[kLanes], Test& test) const;
  static bool openLanes(Link& link, const GroupBoxes& boxes, const ContactBox& box, btScalar path, btScalar reach,
                        bool (&open)[kLanes]);

  /// Difference of the bodies' centroids when last read, and the paths of their nodes until then.
  btVector3 apart_{0, 0, 0};
  double travelled_ = 0;
  double path_ = 0;   ///< bound of the relative motion of any two nodes since candidates were found
  double moved_ = 0;  ///< path of the last step
  double slack_ = -1;
  std::vector<Run> runs_;
  std::vector<Link> links_;         ///< by run
  std::vector<std::size_t> groups_; ///< found for a leaf of runs
};

/// Sets the clearance of those lanes whose boxes are apart from a box. Returns true if some are left to be tested.
inline bool PairCandidates::openLanes(Link& link, const GroupBoxes& boxes, const ContactBox& box, btScalar path,
                                      btScalar reach, bool (&open)[kLanes]) {
  btScalar gap[kLanes];
  for (int k = 0; k < kLanes; ++k) {
    const btScalar x = std::max(box.low[0] - boxes.high[0][k], boxes.low[0][k] - box.high[0]);
    const btScalar y = std::max(box.low[1] - boxes.high[1][k], boxes.low[1][k] - box.high[1]);
    const btScalar z = std::max(box.low[2] - boxes.high[2][k], boxes.low[2][k] - box.high[2]);
    gap[k] = std::max(std::max(x, y), z);
  }
  bool any = false;
  for (int k = 0; k < kLanes; ++k) {
    const bool clear = (path < link.outside[k]) & (path + reach < link.distance[k]);
    const bool apart = !clear & (gap[k] > 0);
    link.outside[k] = apart ? path + gap[k] : link.outside[k];
    link.distance[k] = apart ? kForever : link.distance[k];
    open[k] = !clear & !apart;
    any |= open[k];
  }
  return any;
}

template <class Test>
void PairCandidates::testOpen(Link& link, const TetGroup& tets, const bool (&open)[kLanes], Test& test) const {
  const auto path = static_cast<btScalar>(path_);
  for (std::size_t k = 0; k < kLanes; ++k) {
    if (!open[k]) continue;
    const Clearance found = test(tets[k]);
    link.outside[k] = path + found.outside;
    link.distance[k] = path + found.distance;
  }
}

template <class Begin, class Test, class End>
void PairCandidates::visit(const ContactBody& first, const ContactBody& second, btScalar reach, Begin&& begin,
                           Test&& test, End&& end) {
  assert(hold());
  const auto path = static_cast<btScalar>(path_);
  const std::vector<TetGroup>& groups = second.data().groups;
  for (Run& run : runs_) {
    if (path < run.until.outside && path + reach < run.until.distance) continue;
    bool open[kLanes], any = false;
    const ContactBox loose = first.runBox(run.run);
    for (std::size_t c = run.first; c < run.last; ++c) {
      any |= openLanes(links_[c], second.groupBoxes[static_cast<std::size_t>(links_[c].group)], loose, path, reach,
                       open);
    }
    if (any) {
      const ContactBox box = begin(run.run);
      for (std::size_t c = run.first; c < run.last; ++c) {
        const auto g = static_cast<std::size_t>(links_[c].group);
        if (openLanes(links_[c], second.groupBoxes[g], box, path, reach, open)) testOpen(links_[c], groups[g], open, test);
      }
      end(run.run);
    }
    run.until = leastOf(run);
  }
}

}  // namespace tetskin::contact_detail
