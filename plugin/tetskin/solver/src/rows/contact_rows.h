// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the contacts and anchors of a step as rows, and what they store from step to step.
#pragma once

#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/solver/src/base/row_source.h>
#include <tetskin/solver/src/rows/contact_row.h>
#include <tetskin/solver/src/rows/row_stiffness.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <vector>

namespace tetskin::bullet_detail {

class ContactRows {
 public:
  /// Collects the rows of all bodies that are elastic here: the points that a search has left in the body, Bullet's
  /// contacts of nodes and faces with rigid objects, and the body's anchors. Call it after velocities have been read.
  void collect(SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds);
  /// Adds contacts among soft bodies, and joints. Sleeping bodies have none.
  void add(PointContacts& contacts, SolverBodies& bodies, btScalar seconds);
  void add(std::vector<PointJoint>& joints, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds);
  /// Call it when all rows have been added.
  void setStiffness(const SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds) {
    stiffness_.set(rows_, origins_, bodies, rigids, seconds);
  }
  /// The factor on a contact's D with which its load gives way as in a step of usual length; known after
  /// `setStiffness`.
  btScalar likeUsual(btScalar seconds) const { return stiffness_.likeUsual(seconds); }
  /// Writes or reads the state that is not in the bodies.
  void serialize(StateStream& stream) { stiffness_.serialize(stream); }
  /// Adds any other row, such as one between rigid bodies.
  void add(const ContactRow& row, const RowOrigin& origin);
  /// Stores what the next step starts with, and reports the impulses to the contacts.
  void finish(SolverBodies& bodies, btScalar seconds) const;

  std::vector<ContactRow>& rows() { return rows_; }
  const std::vector<ContactRow>& rows() const { return rows_; }
  /// row  one of `rows`
  const RowOrigin& originOf(const ContactRow& row) const {
    return origins_[static_cast<std::size_t>(&row - rows_.data())];
  }

 private:
  void addBody(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds);
  void addAnchors(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds);

  RowStiffness stiffness_;
  std::vector<ContactRow> rows_;
  std::vector<RowOrigin> origins_;  ///< by row
};

}  // namespace tetskin::bullet_detail
