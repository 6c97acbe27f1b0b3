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
  bool pierces = false;   ///< deeper than what slides along another surface can be, or was
  int next = -1;          ///< another of the same node
};

/// What a pair of bodies keeps from step to step, of the first's samples in the second.
struct PairMemory {
  PairCandidates candidates;
  ContactSides sides;
  std::vector<int> touched;  ///< samples by which nodes did last, ascending
  std::vector<int> pierced;  ///< those that did so from beneath, in the last step
};

/// By how much one body is in another, by its samples.
struct Overlap {
  btScalar deepest = 0;        ///< distance, below 0
  btVector3 normals{0, 0, 0};  ///< sum over those that are inside: of their own surface, each of length 1
  int inside = 0;              ///< as many
  int agreeing = 0;            ///< inside or within reach, and their surface looks as the other one does there
};

/// Finds the touches of pairs, one after the other; keeps its memory.
class PairSearch {
 public:
  /// Both read; they may be one body.
  /// reach    of contacts, world space: those farther apart are left out
  /// dt       seconds, of the step that has led here
  /// apart    which way the first is to leave the second, where it is deep in it, and from which depth on; or 0
  /// touches  appended to: for each node of the first body the deepest, of the samples that it carries most, and of
  ///          those that are pushed another way
  Overlap find(ContactBody& first, ContactBody& second, btScalar reach, btScalar dt, const btVector3& apart,
               btScalar deep, PairMemory& memory, std::vector<Touch>& touches);

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
    btVector3 apart;
    btScalar deep;
    ContactSides* sides;
  };

  void remember(PairMemory& memory) const;
  void beginRun(int run);
  Clearance testTet(int tet);
  Clearance offer(int tet, int sample, int k);
  void touchRun(int run);
  void touch(int sample, int run, const Place& place);
  void count(const btVector3& own, const Touch& touch);
  btVector3 restMotion(int sample, const Place& place) const;
  btVector3 ownNormal(int sample, int run) const;
  bool direct(const btVector3& own, bool onFace, Touch& touch) const;
  void keepDeepest(const Touch& touch, int node);
  btScalar rankOf(const Touch& touch) const;

  Search now_{};
  SampleRun run_;                       ///< in this one's turn
  ContactBox around_;                   ///< its samples
  std::vector<int> touched_, pierced_;  ///< samples of the step before
  std::vector<btScalar> inside_;        ///< by sample of the run: its least weight in a tet
  std::vector<Place> places_;
  std::vector<int> heads_;  ///< in `places_`, by sample of the run
  std::vector<Touch>* touches_ = nullptr;
  std::vector<int> touchOfNode_;
  Overlap overlap_;
};

}  // namespace tetskin::contact_detail
