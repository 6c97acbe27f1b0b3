// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: its members, and what a step is made of.
#pragma once

#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/src/solver/driven_nodes.h>
#include <tetskin/bullet/src/solver/rigid_ties.h>

#include <vector>

namespace tetskin {

/// An error in velocity that nobody sees, over what the earth's gravity gives in a step.
constexpr double kUnseen = 1e-3 * 9.81;

struct DeformableSolver::Parts {
  explicit Parts(DeformableSolver& ofSolver) : solver(ofSolver) {}

  ForceList& forces() { return solver.m_objective->m_lf; }
  btScalar dt() const { return solver.m_dt; }

  // Which bodies, and which forces on them: deformable_solver.cpp.
  bool collect(const btAlignedObjectArray<btSoftBody*>& world);
  void assign();
  /// Of what is left to Bullet's code in a step that is solved here.
  void useOwnSettings();
  /// Several bodies side by side, or one in pieces.
  void forEachBody(void (Parts::*task)(SolvedBody&, ParallelFor*));

  // Before contacts: solver_prediction.cpp.
  /// The impulses of other forces.
  void applyOthers();
  /// The elastic solve before contacts.
  void predict(SolvedBody& of, ParallelFor* inner);
  void writePrediction(SolvedBody& of) const;
  void predictPositions(SolvedBody& of) const;

  // After contacts: solver_solve.cpp.
  void readContacts(SolvedBody& of);
  void tieRigids();
  void addOthers();
  void solveSystems();
  void solve(const SolvedSystem& system, ParallelFor* inner);
  void solveAgain(const SolvedSystem& system, ParallelFor* inner);
  void startAgain(const SolvedSystem& system, ParallelFor* inner);
  elastic_detail::SolveLimits limitsOf(const SolvedSystem& system) const;
  /// What others add to the matrices times `step`, in `extras`.
  void multiplyOthers(const SolvedSystem& system);
  /// The same times the matrices' own steps, and what ties add, for the conjugate gradient.
  void addProducts(const SolvedSystem& system, std::vector<const btScalar*>& added);
  void writeVelocities(SolvedBody& of) const;

  DeformableSolver& solver;
  SolverBodies bodies;
  DrivenNodes driven;
  RigidTies ties;
  HiddenBodies hidden;
  ParallelFor* threads = nullptr;
  bool nodeNormals = true;
  bool always = false;  ///< see DeformableSolver::solveAlways
  bool solving = true;  ///< in this step
  int iterations = 0;
  btAlignedObjectArray<btSoftBody*> all;
  VectorStack step, image;                    ///< of systems with other forces
  std::vector<std::vector<btScalar>> extras;  ///< by body, wide
};

}  // namespace tetskin
