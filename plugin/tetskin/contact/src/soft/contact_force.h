// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: the contacts among its bodies, in each step. It is in the world's list of forces, where a
// DeformableSolver finds it, and is no force itself.
#pragma once

#include <tetskin/bullet/src/shared/solver/row_source.h>
#include <tetskin/contact/src/soft/pair_search.h>

#include <map>
#include <memory>
#include <utility>

namespace tetskin::contact_detail {

class ContactForce : public RowSource {
 public:
  explicit ContactForce(const SoftContactOptions& options) : options_(options) {}

  void include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self);
  void exclude(const btSoftBody& body);
  ContactBody* find(const btSoftBody& body) const;
  bool isGone(const btSoftBody& body) const;
  /// Whether, in the last step, it lay wholly within another body.
  bool isWithin(const ContactBody& body) const;
  /// Of the last step.
  const std::vector<SoftPointContact>& lastContacts() const { return contacts_; }

  std::vector<SoftPointContact>* contacts(btScalar seconds) override;
  void removeSoftBody(btSoftBody* body) override;

 private:
  /// What two bodies, or one with itself, keep from step to step.
  struct Meeting {
    PairMemory memories[2];               ///< of the first in the second, and the other way round
    btVector3 apart{0, 0, 0};             ///< which way the first is to leave the second; 0 unless they overlap
    const ContactBody* within = nullptr;  ///< which of them lies wholly within the other
  };
  using BodyPairs = std::vector<std::pair<ContactBody*, ContactBody*>>;
  BodyPairs pairsThatMeet();
  void forgetAllBut(const BodyPairs& near);
  void findInPair(ContactBody& first, ContactBody& second, btScalar seconds);
  btVector3 search(ContactBody& first, ContactBody& second, btScalar seconds, Meeting& meeting);
  void addContact(const ContactBody& first, const ContactBody& second, const Touch& touch, btScalar seconds);

  SoftContactOptions options_;
  std::vector<std::unique_ptr<ContactBody>> bodies_;
  std::vector<const btSoftBody*> gone_;
  int nextId_ = 0;
  PairSearch search_;
  std::map<std::pair<int, int>, Meeting> meetings_;  ///< by the bodies' ids
  std::vector<Touch> touches_[2];                    ///< of the first in the second, and the other way round
  std::vector<SoftPointContact> contacts_;
};

}  // namespace tetskin::contact_detail
