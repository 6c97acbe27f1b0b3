// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: how long the candidates of a pair stay complete.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <algorithm>
#include <vector>

namespace tetskin::contact_detail {

class RigidMotion;

/// How far the computed position of a point may be from the true one.
inline btScalar roundingOf(const ContactBody& first, const ContactBody& second) {
  return 8 * SIMD_EPSILON * std::max(first.farthest, second.farthest);
}

/// A motion to be added to an accumulated sum, including what rounding of that sum may lose.
/// second  the body whose grid bounds the sum
inline btScalar accountable(btScalar motion, const ContactBody& second) {
  /// Relative to the largest sum, a few cubes.
  constexpr btScalar kLost = btScalar(1e-6);
  return motion > 0 ? motion + kLost * second.data().grid.spacing() : motion;
}

/// Candidates are all samples and tets whose boxes were nearer to each other than a slack. Other pairs have not met as
/// long as no two of their nodes have approached each other by more than the slack or, if they are far from the other
/// body, by more than the distance from all of it. A common rigid motion of both bodies does not count.
class CandidateValidity {
 public:
  /// Begins at the current positions, with a slack that depends on how fast the last one was used up. Both bodies are
  /// fitted.
  /// Cost  O(runs and tets)
  void begin(const ContactBody& first, const ContactBody& second);
  /// Called once after each step. Returns false if a sample may have met a tet that is not a candidate.
  /// Cost  O(1) while the bodies have moved little, else O(nodes)
  bool lasts(const ContactBody& first, const ContactBody& second);

  btScalar slack() const { return slack_; }        ///< world space
  btScalar rounding() const { return rounding_; }  ///< bound of the difference between gaps computed in two steps
  int age() const { return age_; }                 ///< number of steps

 private:
  /// The largest deviation of a body's nodes from a rigid motion: near the other body, and anywhere.
  struct Deviation {
    btScalar near = 0, anywhere = 0;
  };
  void setRounding(const ContactBody& first, const ContactBody& second);
  Deviation deviate(int k, const ContactBody& body, const RigidMotion& motion);
  btScalar usedUp(int k, btScalar spread, btScalar other) const;

  btScalar slack_ = 0;
  btScalar rounding_ = 0;  ///< part of the slack that is never used up
  btScalar moved_ = 0;     ///< bound of the used part of the slack
  btScalar drift_ = 0;     ///< relative motion of nodes that were near, at the last measurement
  int age_ = 0;
  std::vector<int> near_;  ///< nodes of the second body that were near the first one
  // By body, then by node.
  std::vector<btVector3> began_[2];      ///< positions at the beginning
  std::vector<btScalar> rooms_[2];       ///< the slack, or the distance from the other body; infinite: carries nothing
  std::vector<btScalar> deviations_[2];  ///< from the rigid motion
};

}  // namespace tetskin::contact_detail
