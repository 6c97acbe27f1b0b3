// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: how stiff the penalty of each row is, see contact_row.h. By the effective masses of its
// ends, by what shares their nodes, by how fast they meet, and for steps of usual length.
#pragma once

#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/solver/src/rows/contact_row.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <vector>

namespace tetskin::bullet_detail {

class RowStiffness {
 public:
  /// Sets `stiffness`, `tangentStiffness` and `effectiveMass` of all rows of a step, as far as a row has not its own.
  /// origins  by row
  void set(std::vector<ContactRow>& rows, const std::vector<RowOrigin>& origins, const SolverBodies& bodies,
           const RigidUnknowns& rigids, btScalar seconds);
  /// The factor on a contact's D with which its load gives way as in a step of usual length; known after `set`.
  btScalar likeUsual(btScalar seconds) const;
  void serialize(StateStream& stream) { stream(usualStep_); }

 private:
  void followStep(btScalar seconds);
  bool mayTouch(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) const;
  void listLoads(const std::vector<ContactRow>& rows, const std::vector<RowOrigin>& origins, const SolverBodies& bodies,
                 btScalar seconds);
  btScalar sharing(const ContactRow& row, const RowOrigin& origin) const;

  /// A step's usual length in seconds, which slowly follows the steps; 0: none so far. A supported weight gives way as
  /// in a step of this length, whatever the present one is: otherwise each change of the step would act as a push.
  double usualStep_ = 0.0;
  std::vector<std::vector<btScalar>> loads_;  ///< by body and node: weights of the rows that may touch in this step
};

}  // namespace tetskin::bullet_detail
