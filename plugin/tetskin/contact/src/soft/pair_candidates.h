// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: finds which samples of one body may be in which tets of another.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
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

/// Runs of samples of the first body, each with the groups of tets of the second that may contain samples. They stay
/// complete while no two nodes approach each other by more than a slack. Among them, what is clear of the other body is
/// not tested again until it has moved far enough, relative to that part of the other body which is near.
class PairCandidates {
 public:
  /// Records the motion since it was called before, and finds the candidates anew unless they are still complete. Both
  /// bodies have been read; they may be the same one: then tets near to each other at rest are no candidates.
  /// dt    seconds of the step to come
  /// Cost  O(nodes); if candidates are found, about O(number of runs and tets, and of candidates)
  void update(ContactBody& first, ContactBody& second, btScalar dt);

  /// Visits the runs that may have samples in tets, in ascending order: calls begin(run, reach), which returns the box
  /// around its samples, then test(tet) for the tets whose boxes overlap it, in the order of the tree, and end(run).
  /// `test` returns a Clearance: the tet is not tested again until the bodies have moved enough to exceed it. `reach`
  /// is the distance from the surface, world space, from which on no sample of the run can touch it within the step.
  template <class Begin, class Test, class End>
  void visit(const ContactBody& first, const ContactBody& second, Begin&& begin, Test&& test, End&& end);
  bool empty() const { return runs_.empty(); }
  int age() const { return age_; }  ///< number of steps since the candidates were found

 private:
  /// A group of tets that may contain samples of a run.
  struct Link {
    Clearance until{0, 0};  ///< of the whole group: values of the run's path at which clearances end
    int group = 0;
    int lanes = -1;           ///< index in `lanes_`; -1: none has been tested
    unsigned neighbours = 0;  ///< by lane a bit: the tet is no candidate
  };
  /// By lane of a group, the values of the run's path at which clearances end; may be later than that of the group.
  struct Lanes {
    Clearance ends[kLanes] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
  };
  struct Run {
    int run = 0;
    std::size_t first = 0, last = 0;  ///< in `links_`
    Clearance until{0, 0};            ///< the least of its links' values
    btScalar path = 0;   ///< bound of the motion of its samples relative to any tet of its links since they were found
    btScalar reach = 0;  ///< as for `visit`
  };
  /// The distances between a box and those of a group, and the least of them; 0 or below if they overlap.
  struct Gaps {
    btScalar gap[kLanes], least;
  };
  struct Pair {
    const ContactBody* first;
    const ContactBody* second;
    ContactBox overlap;
  };
  bool follow(const ContactBody& first, const ContactBody& second);
  btScalar driftOf(const ContactBody& first, const ContactBody& second) const;
  void find(ContactBody& first, ContactBody& second);
  void findInLeaf(const Pair& pair, std::size_t leaf);
  void findForRun(const Pair& pair, int run);
  void listNodes(const ContactBody& first, const ContactBody& second);
  template <class OfFirst, class OfSecond, class Use>
  void measure(const ContactBody& first, const OfFirst& ofFirst, const OfSecond& ofSecond, Use&& use);
  void setReach(const ContactBody& first, const ContactBody& second, btScalar dt);
  Clearance leastOf(const Run& run) const;
  static Gaps gapsOf(unsigned neighbours, const GroupBoxes& boxes, const ContactBox& box);
  bool closeByBoxes(const Run& run, const ContactBody& second, const ContactBox& box);
  template <class Test>
  void testLink(const Run& run, Link& link, const ContactBody& second, const ContactBox& box, Test& test);
  static bool isClear(const Clearance& until, const Run& run) {
    return run.path < until.outside && run.path + run.reach < until.distance;
  }

  int reads_[2] = {-1, -1};          ///< by body: `reads` when last updated
  btScalar slack_ = 0;               ///< relative motion up to which the candidates stay complete, world space
  btScalar drift_ = 0;               ///< bound of the relative motion of any two nodes since candidates were found
  int age_ = 0;                      ///< number of steps since then
  std::vector<btVector3> found_[2];  ///< by body: positions of its nodes then
  btVector3 centroids_[2] = {{0, 0, 0}, {0, 0, 0}};
  std::vector<int> nodes_[2];  ///< of the runs' tets, and of the tets of all links
  std::vector<Run> runs_;
  std::vector<Link> links_;           ///< by run
  std::vector<Lanes> lanes_;          ///< of those links that have been tested
  std::vector<std::size_t> groups_;   ///< found for a leaf of runs
  std::vector<btScalar> nodeMotion_;  ///< by node of the first body, in `measure`
};

/// Written so that compilers compute the lanes side by side.
inline PairCandidates::Gaps PairCandidates::gapsOf(unsigned neighbours, const GroupBoxes& boxes,
                                                   const ContactBox& box) {
  const auto larger = [](btScalar a, btScalar b) { return a > b ? a : b; };
  Gaps gaps;
  for (int k = 0; k < kLanes; ++k) {
    const btScalar x = larger(box.low[0] - boxes.high[0][k], boxes.low[0][k] - box.high[0]);
    const btScalar y = larger(box.low[1] - boxes.high[1][k], boxes.low[1][k] - box.high[1]);
    const btScalar z = larger(box.low[2] - boxes.high[2][k], boxes.low[2][k] - box.high[2]);
    gaps.gap[k] = larger(larger(x, y), z);
  }
  if (neighbours != 0) {
    for (unsigned k = 0; k < kLanes; ++k) {
      if ((neighbours >> k) & 1U) gaps.gap[k] = kForever;
    }
  }
  static_assert(kLanes == 4, "one comparison for each lane");
  gaps.least = std::min(std::min(gaps.gap[0], gaps.gap[1]), std::min(gaps.gap[2], gaps.gap[3]));
  return gaps;
}

template <class Test>
void PairCandidates::testLink(const Run& run, Link& link, const ContactBody& second, const ContactBox& box,
                              Test& test) {
  const auto g = static_cast<std::size_t>(link.group);
  const Gaps gaps = gapsOf(link.neighbours, second.groupBoxes[g], box);
  link.until = {run.path + gaps.least, kForever};
  if (gaps.least > 0) return;
  link.until = {};
  if (link.lanes < 0) {
    link.lanes = static_cast<int>(lanes_.size());
    lanes_.emplace_back();
  }
  Lanes& lanes = lanes_[static_cast<std::size_t>(link.lanes)];
  for (std::size_t k = 0; k < kLanes; ++k) {
    Clearance& ends = lanes.ends[k];
    if (gaps.gap[k] > 0) {
      ends = {run.path + gaps.gap[k], kForever};
    } else if (!isClear(ends, run)) {
      const Clearance found = test(second.data().groups[g][k]);
      ends = {run.path + found.outside, run.path + found.distance};
    }
    link.until.cut(ends);
  }
}

template <class Begin, class Test, class End>
void PairCandidates::visit(const ContactBody& first, const ContactBody& second, Begin&& begin, Test&& test, End&& end) {
  assert(first.reads == reads_[0] && second.reads == reads_[1]);
  for (Run& run : runs_) {
    if (isClear(run.until, run)) continue;
    if (!closeByBoxes(run, second, first.runBox(run.run))) {
      const ContactBox box = begin(run.run, run.reach);
      for (std::size_t c = run.first; c < run.last; ++c) {
        if (!isClear(links_[c].until, run)) testLink(run, links_[c], second, box, test);
      }
      end(run.run);
    }
    run.until = leastOf(run);
  }
}

}  // namespace tetskin::contact_detail
