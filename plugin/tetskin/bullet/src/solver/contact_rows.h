// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the contacts and anchors of a step as rows, with what they store from step to step.
#pragma once

#include <tetskin/bullet/src/shared/solver/row_source.h>
#include <tetskin/bullet/src/solver/contact_row.h>
#include <tetskin/bullet/src/solver/solver_bodies.h>
#include <tetskin/bullet/src/solver/step_clock.h>

#include <vector>

namespace tetskin {

class ContactRows {
 public:
  /// Collects the rows of all bodies that are elastic here: the points that a search has left in the body, Bullet's
  /// contacts of nodes and faces with rigid objects, and the body's anchors. Call it after velocities have been read.
  /// sources  of contacts among soft bodies, and of joints
  /// clock    at its stage `rows`; the sources' search for contacts is timed apart
  void collect(SolverBodies& bodies, RigidUnknowns& rigids, const std::vector<RowSource*>& sources, btScalar seconds,
               ParallelFor* threads, StepClock& clock);
  /// Stores what the next step begins with, and reports the impulses to the contacts.
  void finish(SolverBodies& bodies, btScalar seconds) const;

  std::vector<ContactRow>& rows() { return rows_; }
  const std::vector<ContactRow>& rows() const { return rows_; }

 private:
  void addBody(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds);
  void addSoft(SolverBodies& bodies, SoftPointContact& contact, btScalar seconds);
  void addJoint(SolverBodies& bodies, PointJoint& joint, RigidUnknowns& rigids, btScalar seconds);
  void addAnchors(SolverBodies& bodies, std::size_t index, RigidUnknowns& rigids, btScalar seconds);
  void setStiffness(SolverBodies& bodies, const RigidUnknowns& rigids, btScalar seconds);

  std::vector<ContactRow> rows_;
};

}  // namespace tetskin
