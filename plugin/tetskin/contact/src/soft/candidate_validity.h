// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: how long the candidates of a pair stay complete.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <vector>

namespace tetskin::contact_detail {

class RigidMotion;

/// Candidates are all samples and tets whose boxes were nearer to each other than a slack. Others have not met while no
/// two of their nodes have approached each other by more than that; far from the other body, by more than the distance
/// from all of it. What both bodies move by in the same way, as by one rigid motion, does not count.
class CandidateValidity {
 public:
  /// Begins at the current positions, with a slack by how fast the one before was used up. Both bodies are fitted.
  /// Cost  O(runs and tets)
  void begin(const ContactBody& first, const ContactBody& second);
  /// Called once after each step. Returns false if a sample may have met a tet that is no candidate.
  /// Cost  O(1) while the bodies have moved little, else O(nodes)
  bool lasts(const ContactBody& first, const ContactBody& second);

  btScalar slack() const { return slack_; }  ///< world space
  int age() const { return age_; }           ///< number of steps

 private:
  /// Of the nodes of a body: their largest deviation from a rigid motion near the other body, and anywhere.
  struct Deviation {
    btScalar near = 0, anywhere = 0;
  };
  Deviation deviate(int k, const ContactBody& body, const RigidMotion& motion);
  btScalar usedUp(int k, btScalar spread, btScalar other) const;

  btScalar slack_ = 0;
  btScalar moved_ = 0;  ///< bound of what has been used up of the slack
  btScalar drift_ = 0;  ///< relative motion of nodes that were near, when it was last measured
  int age_ = 0;
  std::vector<int> near_;  ///< nodes of the second body that were near the first one
  // By body, then by node.
  std::vector<btVector3> began_[2];      ///< positions at the beginning
  std::vector<btScalar> rooms_[2];       ///< the slack, or the distance from the other body; infinite: carries nothing
  std::vector<btScalar> deviations_[2];  ///< from the rigid motion
};

}  // namespace tetskin::contact_detail
