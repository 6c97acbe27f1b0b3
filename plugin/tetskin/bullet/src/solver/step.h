// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: its members, and the stages of a step, in their order.
//
// A node has four numbers, and not one:
//   node            in its body, as the application has it
//   number          first + node, in Bullet's vectors over all bodies: its forces and constraints name nodes so
//   slot            in the body's matrix, sorted by colour, so that rows of one colour are swept side by side
//   wide            where a slot's three numbers are, in groups of slots, one to each lane of a register
// The first two differ by a sum. The last two are BlockMatrix's alone (`slotOf`, `wideOf`): nodes would have to be
// renumbered in the application's body to be rid of them.
#pragma once

#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/src/solver/contact_rows.h>
#include <tetskin/bullet/src/solver/driven_nodes.h>
#include <tetskin/bullet/src/solver/obstacle_changes.h>
#include <tetskin/bullet/src/solver/sleepers.h>

#include <memory>
#include <vector>

namespace tetskin {

class RecordedForces;

/// An error in velocity that nobody sees, over what the earth's gravity gives in a step.
constexpr double kUnseen = 1e-3 * 9.81;

struct DeformableSolver::Parts {
  explicit Parts(DeformableSolver& ofSolver) : solver(ofSolver) {}

  // The stages: step.cpp.
  void gather(const btAlignedObjectArray<btSoftBody*>& world, btScalar seconds);
  void predict();
  void assemble();
  void solve();
  void finishContacts();
  void writeBack();

  ForceList& forces() { return solver.m_objective->m_lf; }
  const btDeformableContactProjection& projection() const { return solver.m_objective->m_projection; }
  btScalar dt() const { return solver.m_dt; }

  // Of gather.
  bool collect(const btAlignedObjectArray<btSoftBody*>& world);
  void assign();

  // Of predict; forces: step_forces.cpp.
  /// Of what is left to Bullet's code in a step that is solved here.
  void useOwnSettings();
  /// The impulses of other forces.
  void applyOthers();
  void predictVelocities(SolvedBody& of, ParallelFor* inner);
  /// most  iterations
  void solveAlone(SolvedBody& of, int most, ParallelFor* inner) const;
  void writePrediction(SolvedBody& of) const;
  void predictPositions(SolvedBody& of);

  // Of assemble; rows: step_rows.cpp.
  void readContacts(SolvedBody& of);
  void addOthers();
  /// Of contacts and anchors, and of what rigid bodies are held by beside; each to the system that it acts on.
  void collectRows();
  std::vector<RowSource*> rowSources();
  void collectRigidRowsOfWorlds();
  void joinByRows();
  void goOn(SolvedBody& of);
  void speculate(const SolvedBody& of) const;

  // Of solve.
  void solveSystem(SolvedSystem& system, ParallelFor* inner);
  /// Adds to the bodies' residuals what others do at the solutions as they are.
  void addOtherResiduals(const SolvedSystem& system);
  /// What others add to the matrices' products with their own steps, in `extras`.
  void beginProducts(const SolvedSystem& system);
  /// The same of `step`.
  void multiplyOthers(const SolvedSystem& system);

  // Of writeBack.
  void writeVelocities(SolvedBody& of) const;

  DeformableSolver& solver;
  SolverBodies bodies;
  DrivenNodes driven;
  Sleepers sleepers;
  ObstacleChanges obstacleChanges;
  RigidUnknowns rigids;
  ContactRows rows;
  HiddenBodies hidden;
  std::weak_ptr<RecordedForces> recorded;  ///< null where nobody asks
  ParallelFor* threads = nullptr;
  bool nodeNormals = true;
  bool always = false;  ///< see DeformableSolver::solveAlways
  bool solving = true;  ///< in this step
  int iterations = 0, passes = 0, unconverged = 0;
  btAlignedObjectArray<btSoftBody*> all;
  VectorStack step, image;                    ///< of systems with other forces
  std::vector<std::vector<btScalar>> extras;  ///< by body, wide
};

}  // namespace tetskin
