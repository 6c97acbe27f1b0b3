// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the solve of one system under contacts, joints and others' forces.
//
// With y the nodes' velocities beside their rigid motions, and V by how much rigid bodies change theirs:
//   A y = b + sum w f + what others do,    M V = sum J^T (f - given)
// with f the rows' impulses, which depend on both (contact_row.h). Newton's method: in each pass rows are linear, with H
// of each in the blocks of its tet, so that sweeps see it; rigid bodies are eliminated; the conjugate gradient solves
// for the rest. Passes go on until it has converged.
#pragma once

#include <tetskin/bullet/src/solver/step.h>

#include <Eigen/LU>
#include <vector>

namespace tetskin {

/// What came of a solve.
struct SolveReport {
  int iterations = 0;
  int passes = 0;
  bool converged = true;
};

class SystemSolve {
 public:
  SystemSolve(DeformableSolver::Parts& step, const SolvedSystem& system, ParallelFor* threads);

  /// From the solutions as they are. Rows have their impulses afterwards, and rigid bodies in Bullet their velocities.
  SolveReport solve();

 private:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  struct BodyState {
    std::vector<btScalar> solution, residual;  ///< wide, when a pass began; of elasticity and others alone
  };

  SolvedBody& bodyAt(std::size_t k) const;
  elastic_detail::SolveLimits limitsWithoutRows() const;
  elastic_detail::SolveLimits limitsOfPass(int pass) const;
  void numberRigids();
  void findResiduals();
  void evaluateRows(btScalar kept);
  void addImpulses();
  void addTangents();
  void addBlocks(std::size_t first, std::size_t last);
  void eliminateRigids();
  void addToNodes(const ContactRow& row, const btVector3& impulse);
  bool start(int pass);
  void keepState();
  void addProducts(std::vector<const btScalar*>& added);
  void moveRigids();
  btScalar searchLine();
  double slope(btScalar share, double linear, double quadratic) const;
  void moveBack(btScalar share);
  void refreshBounds();
  void beginBounds();
  btVector3 velocityOf(const ContactRow& row) const;
  btVector3 nodesOf(const ContactRow& row, bool steps) const;
  void giveMomentum();
  double massOfAll() const;
  double toleranceWithForces(double tolerance, bool anyElastic) const;

  DeformableSolver::Parts& step_;
  const SolvedSystem& system_;
  ParallelFor* threads_;
  std::vector<BodyState> states_;                        ///< by body of the system
  Vector rigidChange_, rigidMomentum_, rigidResidual_;   ///< V, M V, and of the pass what V is to grow by for y = 0
  Vector rigidStep_, rigidPush_;                         ///< of the pass: the growth of V, and of M V
  Matrix inverseMass_, compliance_;                      ///< M^-1; (M + sum J^T H J)^-1
  std::vector<btVector3> before_, stepped_;              ///< by row: u when the pass began, and by how much it changed
};

}  // namespace tetskin
