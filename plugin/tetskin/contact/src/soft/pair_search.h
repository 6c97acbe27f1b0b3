// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: where samples of one body touch another.
#pragma once

#include <tetskin/contact/src/soft/contact_sides.h>
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <vector>

namespace tetskin::contact_detail {

/// A sample of one body at the surface of another, or beneath it.
struct Touch {
  int sample = 0, run = 0;
  int tet = -1;              ///< of the other body
  btScalar weights[4] = {};  ///< in it
  btVector3 normal{0, 1, 0};
  btScalar distance = 0;  ///< world space; below 0: how deep
  int next = -1;          ///< another of the same node
};

/// What a pair of bodies keeps from step to step.
struct PairMemory {
  PairCandidates candidates;
  ContactSides sides;
};

/// Finds the touches of pairs, one after the other; keeps its memory.
class PairSearch {
 public:
  /// Both read; they may be one body.
  /// reach    of contacts, world space: those farther apart are left out
  /// dt       seconds, of the step that has led here
  /// touches  appended to: for each node of the first body the deepest, of the samples that it carries most, and of
  ///          those that are pushed another way
  void find(ContactBody& first, ContactBody& second, btScalar reach, btScalar dt, PairMemory& memory,
            std::vector<Touch>& touches);

 private:
  /// A place of a sample in the second body: where that folds, there are several.
  struct Place {
    int tet = -1, next = -1;
    btScalar weights[4] = {};
    btVector3 rest{0, 0, 0};
    GridDistance nearest;
  };
  struct Search {
    ContactBody* first;
    ContactBody* second;
    btScalar reach, dt;
    ContactSides* sides;
  };

  void placeRun(int run);
  void testTet(int tet, const SampleRun& run, const ContactBox& around);
  void offer(int tet, int sample, int k);
  void touch(int sample, int run, const Place& place);
  btVector3 restMotion(int sample, const Place& place) const;
  bool opposes(int sample, int run, const btVector3& normal) const;
  void keepDeepest(const Touch& touch, int node);

  Search now_{};
  const PairCandidates* candidates_ = nullptr;
  std::vector<btScalar> inside_;  ///< by sample of the run: its least weight in a tet
  std::vector<Place> places_;
  std::vector<int> heads_;  ///< in `places_`, by sample of the run
  std::vector<Touch>* touches_ = nullptr;
  std::vector<int> touchOfNode_;
};

}  // namespace tetskin::contact_detail
