// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: how far two bodies have moved relative to each other since contacts between them were last
// searched for. Later steps depend on it, so it depends only on the bodies, not on the candidates.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>
#include <tetskin/core/src/base/state/state_stream.h>

#include <vector>

namespace tetskin::contact_detail {

class PairMotion {
 public:
  /// Called once in each step. True if, since `markSearched`, no sample and no tet near the other body have approached
  /// each other by more than `maximum`, and if they will not do so in the coming step by more than was expected then.
  /// Both bodies have been read; they may be the same one. False if they have been read more than once since the last
  /// call.
  /// Cost  O(1) while they hardly move, else O(nodes)
  bool isStill(const ContactBody& first, const ContactBody& second, btScalar dt, btScalar maximum);
  /// Called after `isStill`, in the same step.
  void markSearched();
  void serialize(StateStream& stream);
  btScalar sinceSearch() const { return path_; }
  /// False if the next step searches for contacts in any case.
  bool goesOn(const ContactBody& first, const ContactBody& second) const {
    return searched_ && reads_[0] == first.reads && reads_[1] == second.reads;
  }

 private:
  btScalar sinceBefore(const ContactBody& first, const ContactBody& second);
  btScalar inNextStep(const ContactBody& first, const ContactBody& second, btScalar dt);
  void listNear(const ContactBody& first, const ContactBody& second);
  template <class From, class To>
  btScalar measure(const ContactBody& first, const ContactBody& second, const From& from, const To& to);

  int reads_[2] = {-1, -1};  ///< by body: `reads` when last called
  bool searched_ = false;
  btScalar path_ = 0;            ///< since the last search
  btScalar coming_ = 0;          ///< in the coming step
  btScalar searchedComing_ = 0;  ///< the same at the last search
  std::vector<int> near_[2];     ///< nodes of the bodies near each other, during a measurement
};

}  // namespace tetskin::contact_detail
