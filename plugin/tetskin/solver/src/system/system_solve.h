// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the solve of one system under contacts, joints and others' forces.
//
// With y the nodes' velocities relative to their rigid motions, and V the change of the rigid bodies' velocities:
//   A y = b + sum w f + other forces,    M V = sum J^T (f - given)
// with f the rows' impulses, which depend on both (contact_row.h). Newton's method: in each pass rows are linear, with
// H of each in the blocks of its tet, so that sweeps see it; rigid bodies are eliminated; the conjugate gradient solves
// for the rest. Passes go on until it has converged.
#pragma once

#include <tetskin/solver/src/system/reduced_unknowns.h>

#include <vector>

namespace tetskin::bullet_detail {

/// The result of a solve.
struct SolveReport {
  int iterations = 0;
  int passes = 0;
  bool converged = true;
};

class SystemSolve {
 public:
  /// system  of the bodies of the input
  SystemSolve(const SystemInput& input, const SolvedSystem& system, ParallelFor* threads);
  SystemSolve(const SystemSolve&) = delete;  // parts of it refer to others
  SystemSolve& operator=(const SystemSolve&) = delete;

  /// Solves, beginning with the current solutions. Afterwards the rows have their impulses, and the rigid bodies in
  /// Bullet their velocities. Called once.
  SolveReport solve();

 private:
  // The stages of a pass, each of which the one before makes: findResiduals, linearise, reduce, solve, take.
  /// The bodies' residuals without rows, at their current solutions.
  struct Residuals {
    btScalar length = 1;  ///< share of the pass's step that has led to these solutions
  };
  /// Rows that are linear in the velocities; the bodies' residuals and matrices contain them.
  struct Linearised {
    bool derivative = false;  ///< with the derivative of sliding: the step is to be searched along its line
    elastic_detail::SolveLimits limits;
  };
  /// The nodes' equations, without the reduced unknowns. The conjugate gradient has begun.
  struct Reduced {
    bool derivative = false;
    bool isSolved = false;  ///< nothing is left to solve
  };
  /// The step of the whole pass, which solutions and reduced unknowns have taken.
  struct Step {
    bool derivative = false;
    int iterations = 0;
  };

  Residuals findResiduals();
  Linearised linearise(const Residuals& residuals, int pass);
  Reduced reduce(const Linearised& linearised);
  Step solve(const Reduced& reduced);
  /// Goes back to the part of the step that is to be taken.
  Residuals take(const Step& step);

  SolveReport solveOnce();
  SolveReport solvePasses();
  void beginBounds();
  void refreshBounds(btScalar share);
  void readSolution(const SystemBody& body);
  btVector3 velocityOf(std::size_t row) const;
  void evaluateRows(btScalar kept, bool first);
  void addRows(SystemBody& body);
  void listCoupled(SystemBody& body) const;
  void chooseMoving();
  btScalar searchLine(const Residuals& atTheEnd);
  double slope(btScalar fraction, const Slope& of) const;
  void moveBack(btScalar fraction);

  SystemBodies bodies_;
  ReducedUnknowns reduced_;
  CoupledProducts products_;
  elastic_detail::ConjugateGradient<btScalar>& gradient_;
  std::vector<EndVelocities> endVelocities_;  ///< by row: of its ends, by the solutions
  std::vector<btVector3> before_, stepped_;   ///< by row: u when the pass began, and by how much it changed
};

}  // namespace tetskin::bullet_detail
