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

#include <tetskin/bullet/src/solver/component_unknown.h>
#include <tetskin/bullet/src/solver/step.h>

#include <Eigen/Core>
#include <vector>

namespace tetskin {

/// The result of a solve.
struct SolveReport {
  int iterations = 0;
  int passes = 0;
  bool converged = true;
};

class SystemSolve {
 public:
  SystemSolve(DeformableSolver::Impl& step, const SolvedSystem& system, ParallelFor* threads);

  /// Solves, beginning with the current solutions. Afterwards the rows have their impulses, and the rigid bodies in
  /// Bullet their velocities.
  SolveReport solve();

 private:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  /// The component of a body on which an end of a row acts.
  struct EndPart {
    int component = -1;                       ///< in `components_`; below 0: its rigid motion is no separate unknown
    RowMotions motions = RowMotions::Zero();  ///< Z at the end's point
  };
  struct BodyState {
    std::vector<btScalar> solution, residual;  ///< in the wide layout, when a pass began; the residual without rows
  };

  SolvedBody& bodyAt(std::size_t k) const;
  elastic_detail::BlockMatrix<btScalar>& matrixOf(const RowEnd& end) const;

  // The steps of a pass; implemented in system_solve.cpp.
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

  // The few unknowns; implemented in system_elimination.cpp.
  void numberRigids();
  void collectComponents();
  bool isJoined(std::size_t body) const;
  void addComponent(std::size_t body, std::size_t component);
  Dynamics& dynamicsOf(const ComponentUnknown& component) const;
  void moveIntoComponents();
  void moveOutOfComponents();
  Vector6 momentumOf(const ComponentUnknown& component) const;
  void matchComponents();
  void findFewResiduals();
  Matrix fewMatrix() const;
  void addFewStiffness(std::size_t row, std::size_t a, std::size_t b, const Eigen::Matrix3d& h, Matrix& few) const;
  Eigen::Index firstOf(const EndPart& end) const;
  void eliminate();
  void addFew(const Vector& few, bool toResiduals);
  Vector fewOf() const;
  bool collidesWithFew(std::size_t row) const;
  void addCrossProducts();
  void addProducts(std::vector<const btScalar*>& added);
  void moveFew();
  void settleFew();
  void addRowPush(std::size_t row, const btVector3& push, Vector& to) const;
  btVector3 fewVelocity(std::size_t row, const Vector& few) const;
  std::size_t indexOf(std::size_t body) const;

  // Tolerances and line search; implemented in system_limits.cpp and system_line_search.cpp.
  elastic_detail::SolveLimits limitsWithoutRows() const;
  elastic_detail::SolveLimits limitsOfPass(int pass) const;
  double toleranceWithForces(double tolerance, bool anyElastic) const;
  double massOfAll() const;
  btScalar searchLine();
  double slope(btScalar fraction, double linear, double quadratic) const;
  void moveBack(btScalar fraction);

  DeformableSolver::Impl& step_;
  const SolvedSystem& system_;
  ParallelFor* threads_;
  bool joinsSoft_ = false;         ///< true if a row connects two points of soft bodies
  std::vector<BodyState> states_;  ///< by body of the system
  std::vector<ComponentUnknown> components_;
  std::vector<std::array<EndPart, 2>> endParts_;  ///< by row
  // The few unknowns: V of rigid bodies, followed by q of components.
  Eigen::Index rigidSize_ = 0, fewSize_ = 0;
  Vector few_, fewStep_, fewResidual_;  ///< their values; in the pass, their change and the residual of their equations
  Vector partsBefore_;                  ///< momenta of the components when the pass began
  Vector rigidMomentum_, rigidPush_;    ///< M V, and its change in the pass
  Matrix inverseMass_, compliance_;     ///< M^-1; the inverse of the few unknowns' matrix
  std::vector<btVector3> before_, stepped_;  ///< by row: u when the pass began, and by how much it changed
};

}  // namespace tetskin
