// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: finds which samples of one body may be in which tets of another.
#pragma once

#include <tetskin/contact/src/soft/candidate_validity.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <vector>

namespace tetskin::contact_detail {

/// Infinite: no motion exceeds this clearance.
constexpr btScalar kForever = std::numeric_limits<btScalar>::infinity();

/// Upper bound of how much a sample within a tet approaches the surface, per motion relative to the tet. While the tet
/// deforms, the surface may approach faster than its nodes.
constexpr btScalar kApproach = 4;

/// A lower bound of the distance by which samples may move before one of them enters a tet, or reaches the surface;
/// world space. Skipping by it changes no result: a new search would also find nothing.
struct Clearance {
  btScalar outside = kForever;
  /// Of the samples within the tet, the smallest distance from the surface, negative inside: it decreases by at most
  /// `kApproach` times their motion
  btScalar distance = kForever;

  void cut(const Clearance& other) {
    outside = std::min(outside, other.outside);
    distance = std::min(distance, other.distance);
  }
  /// The path lengths at which these clearances end, if the run's path is now this long.
  Clearance endsAt(btScalar path) const { return {path + outside, kApproach * path + distance}; }
};

/// The tet in which a sample was last found, away from the surface, and the end of its clearance in that tet, as in
/// `Clearance::endsAt`.
struct SampleClearance {
  int tet = -1;
  btScalar until = 0;
};

/// A run whose samples must be tested in this step.
struct VisitedRun {
  int run;
  btScalar path;             ///< bound of the motion of its samples relative to the tets near them, since some step
  btScalar reach;            ///< bound of the distance within which its samples may touch the surface in the step
  btScalar rounding;         ///< bound of the error of a distance
  SampleClearance* samples;  ///< by sample of the run: results for this path
};

/// Runs of samples of the first body, each with the groups of tets of the second that may contain samples. They stay
/// complete as long as no two nodes approach each other by more than a slack. A candidate that is clear of the other
/// body is not tested again until it has moved far enough, relative to the nearby part of the other body.
class PairCandidates {
 public:
  /// Records the motion since the last call, and finds the candidates anew unless they are still complete. Both bodies
  /// have been read; they may be the same one: then tets near to each other at rest are not candidates.
  /// dt    seconds of the coming step
  /// Cost  O(nodes); if candidates are found anew, about O(number of runs and tets, and of candidates)
  void update(ContactBody& first, ContactBody& second, btScalar dt);

  /// Visits the runs that may have samples in tets, in ascending order: calls begin(VisitedRun), which returns the box
  /// around its samples, then test(tet) for the tets whose boxes overlap it, in the order of the tree, and end().
  /// `test` returns a Clearance: the tet is not tested again until the bodies have moved enough to exceed it.
  template <class Begin, class Test, class End>
  void visit(const ContactBody& second, Begin&& begin, Test&& test, End&& end);
  bool empty() const { return runs_.empty(); }
  /// Forgets everything: candidates will be found anew. Results do not depend on it.
  void drop() { reads_[0] = reads_[1] = -1; }
  int age() const { return validity_.age(); }  ///< number of steps since the candidates were found

 private:
  /// A group of tets that may contain samples of a run.
  struct Link {
    Clearance until{0, 0};  ///< of the whole group: values of the run's path at which clearances end
    int group = 0;
    int lanes = -1;           ///< index in `lanes_`; -1: no tet has been tested
    unsigned neighbours = 0;  ///< one bit per lane: the tet is not a candidate
  };
  /// By lane of a group, the values of the run's path at which clearances end; may be later than that of the group.
  struct Lanes {
    Clearance ends[kLanes] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
  };
  struct Run {
    int run = 0;
    std::size_t first = 0, last = 0;  ///< in `links_`
    Clearance until{0, 0};            ///< the smallest of its links' values
    btScalar path = 0;   ///< bound of the motion of its samples relative to any tet of its links since these were found
    btScalar reach = 0;  ///< as in VisitedRun
    std::size_t samples = 0;  ///< of its first sample, in `samples_`
  };
  struct Pair {
    const ContactBody* first;
    const ContactBody* second;
    ContactBox overlap;
  };
  bool follow(const ContactBody& first, const ContactBody& second);
  void find(ContactBody& first, ContactBody& second);
  void findInLeaf(const Pair& pair, std::size_t leaf);
  void findForRun(const Pair& pair, int run);
  void listNodes(const ContactBody& first, const ContactBody& second);
  template <class From, class To, class FromOther, class ToOther, class Use>
  void measure(const ContactBody& firstBody, const From& from, const To& to, const ContactBody& secondBody,
               const FromOther& fromOther, const ToOther& toOther, Use&& use);
  void setReach(const ContactBody& first, const ContactBody& second, btScalar dt);
  static Four gapsOf(unsigned neighbours, const GroupBoxes& boxes, const FourBoxes& box);
  template <class Test>
  void testLink(const Run& run, Link& link, const ContactBody& second, const FourBoxes& box, Test& test);
  bool isClear(const Clearance& until, const Run& run) const {
    const btScalar path = run.path + validity_.rounding();
    return path < until.outside && kApproach * path + run.reach < until.distance;
  }

  int reads_[2] = {-1, -1};  ///< by body: `reads` when last updated
  CandidateValidity validity_;
  std::vector<int> nodes_[2];  ///< of the runs' tets, and of the tets of all links
  std::vector<Run> runs_;
  std::vector<Link> links_;               ///< by run
  std::vector<Lanes> lanes_;              ///< of those links that have been tested
  std::vector<SampleClearance> samples_;  ///< by run
  std::vector<std::size_t> groups_;       ///< the groups found for a leaf of runs
  std::vector<btScalar> nodeMotion_;      ///< by node of the first body, in `measure`
};

/// `kForever` in the lanes of neighbours, which are not candidates.
inline Four PairCandidates::gapsOf(unsigned neighbours, const GroupBoxes& boxes, const FourBoxes& box) {
  Four gaps = gapsBetween(box, boxes);
  for (unsigned k = 0; k < kLanes && neighbours != 0; ++k) {
    if ((neighbours >> k) & 1U) gaps[static_cast<int>(k)] = kForever;
  }
  return gaps;
}

template <class Test>
void PairCandidates::testLink(const Run& run, Link& link, const ContactBody& second, const FourBoxes& box, Test& test) {
  const auto g = static_cast<std::size_t>(link.group);
  const Four gaps = gapsOf(link.neighbours, second.groupBoxes[g], box);
  link.until = {run.path + least(gaps), kForever};
  if (link.until.outside > run.path) return;
  link.until = {};
  if (link.lanes < 0) {
    link.lanes = static_cast<int>(lanes_.size());
    lanes_.emplace_back();
  }
  Lanes& lanes = lanes_[static_cast<std::size_t>(link.lanes)];
  for (std::size_t k = 0; k < kLanes; ++k) {
    Clearance& ends = lanes.ends[k];
    if (gaps[static_cast<int>(k)] > 0) {
      ends = {run.path + gaps[static_cast<int>(k)], kForever};
    } else if (!isClear(ends, run)) {
      const Clearance found = test(second.data().groups[g][k]);
      ends = found.endsAt(run.path);
    }
    link.until.cut(ends);
  }
}

template <class Begin, class Test, class End>
void PairCandidates::visit(const ContactBody& second, Begin&& begin, Test&& test, End&& end) {
  assert(second.reads == reads_[1]);
  for (Run& run : runs_) {
    if (isClear(run.until, run)) continue;
    const FourBoxes box(begin(VisitedRun{run.run, run.path, run.reach, validity_.rounding(), &samples_[run.samples]}));
    run.until = {};
    for (std::size_t c = run.first; c < run.last; ++c) {
      if (!isClear(links_[c].until, run)) testLink(run, links_[c], second, box, test);
      run.until.cut(links_[c].until);
    }
    end();
  }
}

}  // namespace tetskin::contact_detail
