// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the solve of one system under contacts, joints and others' forces.
//
// With y the nodes' velocities beside their rigid motions, and V by how much rigid bodies change theirs:
//   A y = b + sum w f + what others do,    M V = sum J^T (f - given)
// with f the rows' impulses, which depend on both (contact_row.h). Newton's method: in each pass rows are linear, with
// H of each in the blocks of its tet, so that sweeps see it; rigid bodies are eliminated; the conjugate gradient solves
// for the rest. Passes go on until it has converged.
#pragma once

#include <tetskin/bullet/src/solver/step.h>

#include <tetskin/core/src/shared/base/aligned.h>

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
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  /// The rigid motion of a part of a stiff body, beside which the nodes' velocities are: sweeps would be slow to find
  /// it, and its stiffness is so large that rounding would hide what it weighs.
  struct PartUnknown {
    std::size_t body = 0;                                                    ///< in SolverBodies::bodies
    Eigen::Index first = 0;                                                  ///< of its six unknowns
    AlignedVector<btScalar> motions[Dynamics::kRigidMotions];                ///< Z: 4 scalars a slot
    AlignedVector<btScalar> images[Dynamics::kRigidMotions];                 ///< A Z, wide
    Eigen::Matrix<double, 6, 6> mass = Eigen::Matrix<double, 6, 6>::Zero();  ///< Z^T A Z
    Vector6 began = Vector6::Zero();                                         ///< Z^T b
  };
  struct BodyState {
    std::vector<btScalar> solution, residual;  ///< wide, when a pass began; of elasticity and others alone
  };

  SolvedBody& bodyAt(std::size_t k) const;
  elastic_detail::SolveLimits limitsWithoutRows() const;
  elastic_detail::SolveLimits limitsOfPass(int pass) const;
  void numberRigids();
  void findResiduals();
  void evaluateRows(btScalar kept, bool first);
  void addImpulses();
  void addTangents();
  void addBlocks(std::size_t first, std::size_t last);
  void addApart(std::size_t first, std::size_t last, std::uint32_t i, std::uint32_t j,
                btScalar (&blocks)[kMaxPointNodes][kMaxPointNodes][6]) const;
  void collectParts();
  void addPart(std::size_t body, std::size_t part);
  void moveIntoParts();
  void moveOutOfParts();
  void addPartMotion(const PartUnknown& part, const Vector& few, btScalar factor);
  Vector6 imageProducts(const PartUnknown& part) const;
  Vector6 partMomentum(const PartUnknown& part) const;
  std::size_t placeOf(std::size_t body) const;
  void findFewResiduals();
  Matrix fewMatrix() const;
  void matchParts();
  void eliminate();
  void addFew(const Vector& few, bool toResiduals);
  Vector fewOf() const;
  void addRowPush(std::size_t row, const btVector3& push, Vector& to) const;
  btVector3 fewVelocity(std::size_t row, const Vector& few) const;
  void addToNodes(const ContactRow& row, const btVector3& impulse);
  bool start(int pass);
  void keepState();
  void addProducts(std::vector<const btScalar*>& added);
  void moveFew();
  btScalar searchLine();
  double slope(btScalar share, double linear, double quadratic) const;
  void moveBack(btScalar share);
  void refreshBounds();
  void beginBounds();
  btVector3 velocityOf(std::size_t row) const;
  btVector3 nodesOf(const ContactRow& row, bool steps) const;
  void giveMomentum();
  double massOfAll() const;
  double toleranceWithForces(double tolerance, bool anyElastic) const;

  DeformableSolver::Parts& step_;
  const SolvedSystem& system_;
  ParallelFor* threads_;
  std::vector<BodyState> states_;  ///< by body of the system
  std::vector<PartUnknown> parts_;
  std::vector<Eigen::Matrix<double, 3, 6>> rowMotions_;  ///< by row: Z where it acts
  std::vector<int> rowParts_;                            ///< by row: in `parts_`, or below 0
  // Few unknowns: V of rigid bodies, and then q of parts.
  Eigen::Index rigidSize_ = 0, fewSize_ = 0;
  Vector few_, fewStep_, fewResidual_;  ///< as they are; of the pass, their growth and what is left of their equations
  Vector partsBefore_;                  ///< momenta of parts when the pass began
  Vector rigidMomentum_, rigidPush_;    ///< M V, and its growth in the pass
  Matrix inverseMass_, compliance_;     ///< M^-1; the inverse of the few unknowns' matrix
  std::vector<btVector3> before_, stepped_;  ///< by row: u when the pass began, and by how much it changed
};

}  // namespace tetskin
