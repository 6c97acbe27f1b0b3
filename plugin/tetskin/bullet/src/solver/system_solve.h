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

#include <tetskin/bullet/src/solver/part_unknown.h>
#include <tetskin/bullet/src/solver/step.h>

#include <Eigen/Core>
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
  /// The part that an end of a row is of.
  struct EndPart {
    int part = -1;                            ///< in `parts_`; below 0: none that is solved for by itself
    RowMotions motions = RowMotions::Zero();  ///< Z there
  };
  struct BodyState {
    std::vector<btScalar> solution, residual;  ///< wide, when a pass began; of elasticity and others alone
  };

  SolvedBody& bodyAt(std::size_t k) const;
  elastic_detail::BlockMatrix<btScalar>& matrixOf(const RowEnd& end) const;

  // A pass: system_solve.cpp.
  void beginBounds();
  void findResiduals();
  void evaluateRows(btScalar kept, bool first);
  bool start(int pass);
  void keepState();
  void addImpulses();
  void addTangents();
  void addBlocks(std::size_t end, std::size_t first, std::size_t last);
  void addApart(std::size_t end, std::size_t first, std::size_t last, std::uint32_t i, std::uint32_t j,
                btScalar (&blocks)[kMaxPointNodes][kMaxPointNodes][6]) const;
  void addToNodes(const RowEnd& end, const btVector3& impulse, btScalar* to) const;
  btVector3 velocityOf(std::size_t row) const;
  btVector3 nodesOf(const ContactRow& row, bool steps) const;
  btVector3 nodesOf(const RowEnd& end, bool steps) const;
  void refreshBounds();
  bool isHung(std::size_t body) const;
  void giveMomentum();

  // The few unknowns: system_elimination.cpp.
  void numberRigids();
  void collectParts();
  bool isJoined(std::size_t body) const;
  void addPart(std::size_t body, std::size_t part);
  Dynamics& dynamicsOf(const PartUnknown& part) const;
  void moveIntoParts();
  void moveOutOfParts();
  Vector6 momentumOf(const PartUnknown& part) const;
  void matchParts();
  void findFewResiduals();
  Matrix fewMatrix() const;
  void addFewStiffness(std::size_t row, std::size_t a, std::size_t b, const Eigen::Matrix3d& h, Matrix& few) const;
  Eigen::Index firstOf(const EndPart& of) const;
  void eliminate();
  void addFew(const Vector& few, bool toResiduals);
  Vector fewOf() const;
  bool meetsFew(std::size_t row) const;
  void addCrossProducts();
  void addProducts(std::vector<const btScalar*>& added);
  void moveFew();
  void settleFew();
  void addRowPush(std::size_t row, const btVector3& push, Vector& to) const;
  btVector3 fewVelocity(std::size_t row, const Vector& few) const;
  std::size_t placeOf(std::size_t body) const;

  // How closely, and how far: system_limits.cpp, system_line_search.cpp.
  elastic_detail::SolveLimits limitsWithoutRows() const;
  elastic_detail::SolveLimits limitsOfPass(int pass) const;
  double toleranceWithForces(double tolerance, bool anyElastic) const;
  double massOfAll() const;
  btScalar searchLine();
  double slope(btScalar share, double linear, double quadratic) const;
  void moveBack(btScalar share);

  DeformableSolver::Parts& step_;
  const SolvedSystem& system_;
  ParallelFor* threads_;
  bool joinsSoft_ = false;         ///< any row two points of soft bodies
  std::vector<BodyState> states_;  ///< by body of the system
  std::vector<PartUnknown> parts_;
  std::vector<std::array<EndPart, 2>> endParts_;  ///< by row
  // Few unknowns: V of rigid bodies, and then q of parts.
  Eigen::Index rigidSize_ = 0, fewSize_ = 0;
  Vector few_, fewStep_, fewResidual_;  ///< as they are; of the pass, their growth and what is left of their equations
  Vector partsBefore_;                  ///< momenta of parts when the pass began
  Vector rigidMomentum_, rigidPush_;    ///< M V, and its growth in the pass
  Matrix inverseMass_, compliance_;     ///< M^-1; the inverse of the few unknowns' matrix
  std::vector<btVector3> before_, stepped_;  ///< by row: u when the pass began, and by how much it changed
};

}  // namespace tetskin
