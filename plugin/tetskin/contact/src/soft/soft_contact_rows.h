// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: the contacts among its bodies, in each step. An entry in the world's list of forces, in
// which a DeformableSolver finds it; it applies no force itself.
#pragma once

#include <tetskin/contact/src/soft/pair_search.h>
#include <tetskin/solver/src/base/row_source.h>

#include <map>
#include <memory>
#include <utility>

namespace tetskin::contact_detail {

class SoftContactRows : public bullet_detail::RowSource {
 public:
  explicit SoftContactRows(const SoftContactOptions& options) : options_(options) {}

  void include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self);
  void exclude(const btSoftBody& body);
  /// Excludes bodies that were deleted: after their world's end, they can no longer report it. Includes bodies again
  /// that were taken out of the world and are back.
  void updateBodies();
  ContactBody* find(const btSoftBody& body) const;
  /// True for a body that was added but is not in the world.
  bool isGone(const btSoftBody& body) const;
  /// True if the body lay wholly inside another one in the last step.
  bool isWithin(const ContactBody& body) const;
  /// The contacts of the last step, and those between sleeping bodies, as they were when these fell asleep.
  const bullet_detail::PointContacts& lastContacts() const { return contacts_; }
  const bullet_detail::PointContacts& sleepingContacts() const { return sleeping_; }

  /// Results do not depend on candidates; only the time of a search does.
  void dropCandidates();

  bullet_detail::PointContacts* contacts(btScalar seconds, ParallelFor* threads) override;
  void removeSoftBody(btSoftBody* body) override;
  void forget(const btSoftBody& body) override;
  void shift(const btVector3& by) override;
  /// Of the last step's contacts, only those between sleeping bodies are kept; the others are reset, as before a step.
  void serialize(bullet_detail::WorldStream& stream) override;
  void checkState(bullet_detail::WorldStream& stream) override;

 private:
  /// State that two bodies, or one body with itself, keep from step to step.
  struct PairState {
    std::vector<Touch> touches[2];  ///< of the first body in the second, and of the second in the first
    PairMemory memories[2];         ///< of the first body in the second, and of the second in the first
    btVector3 apart{0, 0, 0};  ///< direction in which the first body is pushed out of the second; 0 unless they overlap
    const ContactBody* within = nullptr;  ///< the one that lies wholly inside the other, or null
  };
  /// Two bodies that may touch, or one body with itself.
  struct SearchedPair {
    ContactBody* first;
    ContactBody* second;
    PairState* state;
  };
  using BodyPairs = std::vector<std::pair<ContactBody*, ContactBody*>>;
  std::unique_ptr<ContactBody> take(const btSoftBody& body);
  void includeReturned();
  void forgetPairs(const ContactBody& body);
  void serializeBodies(bullet_detail::WorldStream& stream);
  void serializePairs(bullet_detail::WorldStream& stream);
  void serializePair(bullet_detail::WorldStream& stream, const std::pair<int, int>& ids, PairState& state);
  void serializeSleeping(bullet_detail::WorldStream& stream);
  ContactBody* withId(int id) const;
  bool motionMatters(const ContactBody& body) const;
  void keepSleeping();
  BodyPairs overlappingPairs();
  void forgetAllBut(const BodyPairs& near);
  void findInPairs(const std::vector<SearchedPair>& pairs, btScalar seconds, ParallelFor* threads);
  static void findInPair(const SearchedPair& pair, btScalar seconds, PairSearch& finder);
  static btVector3 search(const SearchedPair& pair, btScalar seconds, PairSearch& finder);
  void addContact(const ContactBody& first, const ContactBody& second, const Touch& touch, btScalar seconds);

  SoftContactOptions options_;
  std::vector<std::unique_ptr<ContactBody>> bodies_;
  std::vector<std::unique_ptr<ContactBody>> away_;  ///< out of the world; they may come back
  std::vector<const btSoftBody*> gone_;             ///< also out of the world, but may have been destroyed
  int nextId_ = 0;
  std::vector<PairSearch> searches_;                     ///< one for each task
  std::map<std::pair<int, int>, PairState> pairStates_;  ///< by the bodies' ids
  bullet_detail::PointContacts contacts_, sleeping_;
};

}  // namespace tetskin::contact_detail
