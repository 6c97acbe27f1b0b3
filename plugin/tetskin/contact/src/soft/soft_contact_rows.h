// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: the contacts among its bodies, in each step. It is an entry in the world's list of forces,
// where a DeformableSolver finds it, but applies no force itself.
#pragma once

#include <tetskin/contact/src/soft/pair_search.h>
#include <tetskin/solver/src/base/row_source.h>

#include <map>
#include <memory>
#include <utility>

namespace tetskin::contact_detail {

using namespace bullet_detail;

class SoftContactRows : public RowSource {
 public:
  explicit SoftContactRows(const SoftContactOptions& options) : options_(options) {}

  void include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self);
  void exclude(const btSoftBody& body);
  /// Excludes bodies that were deleted, which after their world cannot tell any more that they go; and includes those
  /// again that were taken out of the world, and are in it again.
  void updateBodies();
  ContactBody* find(const btSoftBody& body) const;
  /// True of a body that was added, and is not in the world.
  bool isGone(const btSoftBody& body) const;
  /// True if the body lay wholly within another one in the last step.
  bool isWithin(const ContactBody& body) const;
  /// The contacts of the last step, and those between bodies that sleep, as they were when these fell asleep.
  const PointContacts& lastContacts() const { return contacts_; }
  const PointContacts& sleepingContacts() const { return sleeping_; }

  /// Nothing depends on candidates but the time that a search takes.
  void dropCandidates();

  PointContacts* contacts(btScalar seconds, ParallelFor* threads) override;
  void removeSoftBody(btSoftBody* body) override;
  void forget(const btSoftBody& body) override;
  void shift(const btVector3& by) override;
  /// Of the contacts of the last step, those between bodies that sleep are kept; others are as before a step.
  void visitState(WorldStream& stream) override;
  void checkState(WorldStream& stream) override;

 private:
  /// What two bodies, or one body with itself, store from step to step.
  struct PairState {
    std::vector<Touch> touches[2];  ///< of the first body in the second, and of the second in the first
    PairMemory memories[2];         ///< of the first body in the second, and of the second in the first
    btVector3 apart{0, 0, 0};       ///< direction in which the first body is to leave the second; 0 unless they overlap
    const ContactBody* within = nullptr;  ///< the one that lies wholly within the other, or null
  };
  /// Two bodies that may touch, or one with itself.
  struct SearchedPair {
    ContactBody* first;
    ContactBody* second;
    PairState* state;
  };
  using BodyPairs = std::vector<std::pair<ContactBody*, ContactBody*>>;
  std::unique_ptr<ContactBody> take(const btSoftBody& body);
  void includeReturned();
  void forgetPairs(const ContactBody& body);
  void visitBodies(WorldStream& stream);
  void visitPairs(WorldStream& stream);
  void visitPair(WorldStream& stream, const std::pair<int, int>& ids, PairState& state);
  void visitSleeping(WorldStream& stream);
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
  std::vector<const btSoftBody*> gone_;             ///< the same of bodies that may have been destroyed
  int nextId_ = 0;
  std::vector<PairSearch> searches_;                     ///< one for each task
  std::map<std::pair<int, int>, PairState> pairStates_;  ///< by the bodies' ids
  PointContacts contacts_, sleeping_;
};

}  // namespace tetskin::contact_detail
