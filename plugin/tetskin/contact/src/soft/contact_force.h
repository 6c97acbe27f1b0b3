// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: what a DeformableSolver calls, in a step:
//   reinitialize                contacts of the positions that the step begins with; their impulses by masses alone
//   addScaledExplicitForce      these impulses
//   addScaledDampingForce       what it takes to hold contacts
//   addScaledDampingForceDifferential  the same, for velocities that the solve tries
#pragma once

#include <tetskin/bullet/coupling_force.h>
#include <tetskin/contact/src/soft/contact_estimate.h>

#include <map>

class btDeformableBodySolver;

namespace tetskin::contact_detail {

class ContactForce : public CouplingForce {
 public:
  ContactForce(btDeformableBodySolver& solver, btSoftBodyWorldInfo& worldInfo, const SoftContactOptions& options)
      : solver_(solver), worldInfo_(worldInfo), options_(options) {}

  void include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self);
  void exclude(const btSoftBody& body);
  ContactBody* find(const btSoftBody& body) const;
  bool isGone(const btSoftBody& body) const;
  const std::vector<ContactRow>& rows() const { return rows_; }

  const std::vector<std::array<btSoftBody*, 2>>& pairs() const override { return pairs_; }
  void addSoftBody(btSoftBody*) override {}
  void removeSoftBody(btSoftBody* body) override;
  void reinitialize(bool nodeUpdated) override;
  void addScaledExplicitForce(btScalar scale, TVStack& force) override;
  void addScaledDampingForce(btScalar scale, TVStack& force) override;
  void addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) override;

 private:
  void readBodies();
  using BodyPairs = std::vector<std::pair<ContactBody*, ContactBody*>>;
  void detect();
  void forgetAllBut(const BodyPairs& near);
  void detectPair(ContactBody& first, ContactBody& second);
  void addRow(ContactBody& first, ContactBody& second, const Touch& touch);
  void predictVelocities();
  void keepNear();
  void wakeTouched();
  void nameBodies();
  btScalar firmness(const ContactRow& row) const;

  btDeformableBodySolver& solver_;
  btSoftBodyWorldInfo& worldInfo_;
  SoftContactOptions options_;
  BodyList bodies_;
  std::vector<const btSoftBody*> gone_;
  int nextId_ = 0;
  bool removal_ = false;  ///< Bullet calls `reinitialize` next, and it is no step
  btScalar dt_ = 0;
  PairSearch search_;
  std::map<std::pair<int, int>, PairMemory> pairMemory_;  ///< by the bodies' ids
  std::vector<Touch> touches_;
  std::vector<ContactRow> rows_;
  std::vector<ContactMemory> memory_;
  std::vector<std::array<btSoftBody*, 2>> pairs_;
};

}  // namespace tetskin::contact_detail
