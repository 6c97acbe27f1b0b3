// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: finds where samples of one body touch another.
#pragma once

#include <tetskin/contact/src/soft/contact_normal.h>
#include <tetskin/contact/src/soft/contact_sides.h>
#include <tetskin/contact/src/soft/node_touches.h>
#include <tetskin/contact/src/soft/pair_candidates.h>
#include <tetskin/contact/src/soft/pair_motion.h>

#include <cstdint>
#include <vector>

namespace tetskin::contact_detail {

/// The overlap of one body with another, measured by its samples.
struct Overlap {
  btScalar deepest = 0;        ///< least distance, below 0
  btVector3 normals{0, 0, 0};  ///< sum of the unit normals of the samples inside
  int inside = 0;              ///< number of samples inside
  int agreeing = 0;  ///< number of samples inside or within reach whose normals agree with those of the other surface
};

/// What a pair of bodies stores from step to step about the first one's samples in the second one.
struct PairMemory {
  PairCandidates candidates;  ///< nothing depends on them but the time that a search takes
  PairMotion motion;
  ContactSides sides;
  Overlap overlap;       ///< when the touches were searched for
  bool follows = false;  ///< they may be followed: that search had no direction in which the body was to leave
  std::vector<TouchedSample> touched;  ///< samples by which nodes have touched, ascending
  std::vector<int> pierced;            ///< samples that pierced the surface in the last step

  /// True if the next step may follow the touches of this one.
  bool mayFollow(const ContactBody& first, const ContactBody& second) const {
    return follows && motion.goesOn(first, second);
  }
  /// touches   those of the last step
  /// followed  whether they are saved: `mayFollow`
  void serialize(bullet_detail::WorldStream& stream, std::vector<Touch>& touches, bool followed);
  /// True if all that it holds is of these bodies.
  bool fits(const ContactBody& first, const ContactBody& second, const std::vector<Touch>& touches) const;
};

/// Finds the touches of pairs, one pair after the other; reuses its memory.
class PairSearch {
 public:
  /// Finds the touches of a pair. Both bodies have been read; they may be the same one.
  /// dt       seconds of the step that has led here, and of the one to come: samples that cannot reach the surface
  ///          within it are left out
  /// apart    direction in which the first body is to leave the second, where it is deep in it, and the depth from
  ///          which on it applies; or 0
  /// touches  those of the step before, on return those of this step: see NodeTouches. While the bodies have hardly
  ///          moved relative to each other, they stay the same samples in the same tets
  Overlap find(ContactBody& first, ContactBody& second, btScalar dt, const btVector3& apart, btScalar deep,
               PairMemory& memory, std::vector<Touch>& touches);

 private:
  /// A position of a sample in the second body: where that body folds, there are several.
  struct SamplePosition {
    int tet = -1, next = -1;
    btScalar weights[4] = {};
    btVector3 rest{0, 0, 0};
    GridDistance nearest;
    btScalar reach = 0;  ///< distance from which on it cannot touch the surface within the step
  };
  struct Search {
    ContactBody* first;
    ContactBody* second;
    btScalar dt;
    btVector3 apart;
    btScalar deep;
    ContactSides* sides;
  };

  /// A tet of the second body, as last computed for the pair with this number.
  struct KnownTet {
    std::uint64_t pair = 0;
    DeformedTet tet;
  };

  bool follow(std::vector<Touch>& touches);
  const ContactBox& beginRun(const VisitedRun& run);
  void carryRun();
  const DeformedTet& deformed(int tet);
  btVector3 sampleAt(int k) const;
  Clearance testTet(int tet);
  btScalar findDepths(const DeformedTet& tet);
  Clearance testSample(int tet, int k);
  bool isCarried(int tet, const btVector3& at);
  Clearance addPosition(int tet, int sample, int k);
  void touchRun();
  void makeTouch(int k, const SamplePosition& position);
  void accumulateOverlap(const btVector3& own, const Touch& touch);
  btScalar reachOf(int sample, const SamplePosition& position) const;
  btVector3 velocityOf(int sample, const SamplePosition& position) const;
  btVector3 restMotion(int sample, const SamplePosition& position);
  btVector3 ownNormal(int sample) const;
  SampleSurface surfaceOf(int sample) const;

  Search now_{};
  std::uint64_t pair_ = 0;       ///< number of the pair that is searched
  std::vector<KnownTet> known_;  ///< by tet
  VisitedRun visited_{};         ///< the run that is being tested
  SampleRun run_;                ///< the same one: its samples
  DeformedTet own_;              ///< its tet, if one of its samples touches
  ContactBox around_;            ///< box of its samples
  std::size_t padded_ = 0;       ///< number of its samples, rounded up to lanes
  std::vector<btScalar>
      carried_[3];                ///< by sample of the run: its coordinates; lanes that are left over repeat the last
  std::vector<btScalar> inside_;  ///< by sample of the run: how far inside of the tet it is
  std::vector<int> pierced_;      ///< samples of the step before
  std::vector<SamplePosition> positions_;
  std::vector<int> heads_;  ///< by sample of the run: index in `positions_`
  NodeTouches touches_;
  Overlap overlap_;
};

}  // namespace tetskin::contact_detail
