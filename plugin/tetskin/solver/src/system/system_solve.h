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

#include <tetskin/core/src/base/run_by_size.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/system/body_ends.h>
#include <tetskin/solver/src/system/component_unknown.h>
#include <tetskin/solver/src/system/other_forces.h>
#include <tetskin/solver/src/system/schur_complement.h>

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace tetskin::bullet_detail {

/// The result of a solve.
struct SolveReport {
  int iterations = 0;
  int passes = 0;
  bool converged = true;
};

/// What the solve of a system reads, and where it writes: the step's.
struct SystemInput {
  SolverBodies& bodies;
  const ContactRows& rows;
  RigidUnknowns& rigids;
  OtherForces& others;
};

/// Work on bodies runs in parallel over bodies, and work on rows over rows; sums over bodies and rows are in their
/// order.
class SystemSolve : private elastic_detail::ConjugateGradient<btScalar>::CouplingOperator {
 public:
  /// system  of the bodies of the input
  SystemSolve(const SystemInput& input, const SolvedSystem& system, ParallelFor* threads);

  /// Solves, beginning with the current solutions. Afterwards the rows have their impulses, and the rigid bodies in
  /// Bullet their velocities.
  SolveReport solve();

 private:
  using Vector = Eigen::VectorXd;
  using HeldPoint = elastic_detail::HeldPoint<btScalar>;
  /// A body of the system.
  struct Body {
    Body(std::size_t number, SolvedBody& of) : index(number), solved(of), ends(of.dynamics->matrix()) {}
    Dynamics& dynamics() const { return *solved.dynamics; }
    elastic_detail::BlockMatrix<btScalar>& matrix() const { return solved.dynamics->matrix(); }

    std::size_t index;  ///< in SolverBodies::bodies
    SolvedBody& solved;
    BodyEnds ends;
    std::vector<std::uint32_t> coupled;        ///< those of `ends` that the current pass couples to anything else
    bool moves = true;                         ///< in the current pass; others keep their solutions
    std::vector<btScalar> solution, residual;  ///< in the wide layout, when a pass began; the residual without rows
    std::size_t firstComponent = 0, lastComponent = 0;  ///< in `components_`
    double byMatrix = 0.0, byMasses = 0.0;              ///< squares of the solution, as SystemSolve::limitsOfPass adds
    double linear = 0.0, quadratic = 0.0;               ///< its share in SystemSolve::searchLine
  };
  using EndVelocities = std::array<btVector3, 2>;

  /// Calls call(body, inner) for each body.
  template <class Call>
  void forEachBody(Call&& call) {
    runBySize(
        threads_, sizes_, [&](std::size_t k) { return elastic_detail::isDivisible(sizes_[k]); },
        [&](std::size_t k, ParallelFor* inner) { call(bodies_[k], inner); });
  }
  /// Calls call(r) for each row.
  template <class Call>
  void forEachRow(Call&& call) {
    // Enough work that handing it out costs little.
    constexpr std::size_t kRowsPerTask = 128;
    const std::size_t count = system_.rows.size();
    runTasks(threads_, (count + kRowsPerTask - 1) / kRowsPerTask, [&](std::size_t task) {
      for (std::size_t r = task * kRowsPerTask; r < std::min(count, (task + 1) * kRowsPerTask); ++r) call(r);
    });
  }

  // The steps of a pass; implemented in system_solve.cpp.
  void collectBodies();
  void collectEnds();
  void beginBounds();
  void readSolution(Body& body);
  void findResiduals();
  void evaluateRows(btScalar kept, bool first);
  bool start(int pass);
  void chooseMoving();
  void addRows(Body& body);
  void listCoupled(Body& body) const;
  btVector3 velocityOf(std::size_t row) const;
  /// The point of an end that is soft.
  const CarriedPoint& pointOf(std::size_t row, std::size_t index) const {
    return in_.rows.originOf(*system_.rows[row]).points[index];
  }
  void refreshBounds(btScalar share);
  bool isHung(const Body& body) const;
  void giveMomentum();
  void removeMomentumError(Body& body) const;
  void addTorqueOfGap(const Body& body, const BodyEnd& end, const btVector3& impulse,
                      std::vector<std::array<double, 3>>& torques) const;
  void findHeld(const Body& body, std::vector<HeldPoint>& held, std::vector<ContactRow*>& rows) const;

  // Vectors of the reduced unknowns. By loops: each of Eigen's expressions takes the compiler tenths of a second.
  static Vector zeros(Eigen::Index size);
  /// to += factor of, for all numbers of `of`, which is the shorter one
  static void addTimes(double factor, const Vector& of, Vector& to);
  /// The product of the first `size` numbers of both.
  static double dotOfFirst(Eigen::Index size, const Vector& a, const Vector& b);
  static Small6 partOf(const Vector& of, const ComponentUnknown& component) {
    return smallFrom<6>(of.data() + component.first);
  }
  static void setPart(Vector& of, const ComponentUnknown& component, const Small6& to) {
    std::copy(to.values, to.values + 6, of.data() + component.first);
  }
  static void addPart(Vector& of, const ComponentUnknown& component, const Small6& more) {
    setPart(of, component, partOf(of, component) + more);
  }

  // The reduced unknowns; implemented in system_elimination.cpp.
  void numberRigids();
  void collectComponents();
  void coupleReduced();
  Eigen::Index firstReduced(std::size_t row, std::size_t end) const;
  bool needsComponents(const Body& body) const;
  bool isJoined(const Body& body) const;
  void findEndMotions(const Body& body);
  void moveIntoComponents(const Body& body);
  void moveOutOfComponents(const Body& body);
  Small6 momentumOf(const ComponentUnknown& component) const;
  void matchComponents(const Body& body);
  void findReducedResiduals();
  void findReducedStiffness();
  void addReducedStiffness(std::size_t row, std::size_t a, std::size_t b, const Small3x3& h);
  bool hasRowMotions(std::size_t row, std::size_t end) const;
  RowMotions rowMotions(std::size_t row, std::size_t end) const;
  RigidUnknowns::Jacobian jacobianOf(std::size_t row, std::size_t end) const;
  bool isOnComponent(std::size_t row, std::size_t end) const { return componentOf_[row][end] != nullptr; }
  void eliminate();
  bool couplesReduced(std::size_t row) const;
  void moveReduced();
  void settleReduced();
  void addRowPush(std::size_t row, const btVector3& push, Vector& to) const;
  void addRowPushes(const std::vector<btVector3>& steps, Vector& to) const;
  btVector3 reducedVelocity(std::size_t row, const Vector& reduced) const;
  void addReduced(const Body& body, const Vector& reduced, btScalar sign, bool withOthers, btScalar* to) const;

  // What is added to the matrices' products; implemented in system_elimination.cpp.
  void readPoints(std::size_t k) override;
  void combine() override;
  const btScalar* apply(std::size_t k) override;

  // Tolerances, implemented in system_limits.cpp; and line search.
  elastic_detail::SolveLimits limitsOfBulletsForces() const;
  elastic_detail::SolveLimits limitsWithoutRows() const;
  elastic_detail::SolveLimits limitsOfPass(int pass) const;
  double toleranceWithForces(double tolerance) const;
  btScalar searchLine();
  double slope(btScalar fraction, double linear, double quadratic) const;
  void moveBack(btScalar fraction);

  SystemInput in_;
  const SolvedSystem& system_;
  ParallelFor* threads_;
  bool joinsSoft_ = false;  ///< true if a row connects two points of soft bodies
  std::vector<Body> bodies_;
  std::vector<std::size_t> sizes_;   ///< by body: slots
  std::vector<std::size_t> moving_;  ///< those that move in the current pass, ascending
  std::vector<ComponentUnknown> components_;
  /// By row and end: the component on which the end acts, null where its rigid motion is no separate unknown; and Z at
  /// the end's point.
  std::vector<std::array<const ComponentUnknown*, 2>> componentOf_;
  std::vector<std::array<RowMotions, 2>> motionsOf_;
  // The reduced unknowns: V of rigid bodies, followed by q of components.
  Eigen::Index rigidSize_ = 0, reducedSize_ = 0;
  Vector reduced_, reducedStep_,
      reducedResidual_;               ///< their values; in the pass, their change and the residual of their equations
  Vector images_, imagesBefore_;      ///< of components: Z^T A y, now and when the pass began
  Vector partsBefore_;                ///< momenta of the components when the pass began
  Vector rigidMomentum_, rigidPush_;  ///< M V, and its change in the pass
  SchurComplement schurComplement_;
  std::vector<std::size_t> reducedRows_;  ///< those with an end that reduced unknowns move, ascending
  Vector stepImages_;                     ///< of components: Z^T A times the step of the conjugate gradient
  Vector reducedOfStep_;                  ///< what the step of the conjugate gradient changes the reduced unknowns by
  std::vector<EndVelocities> endVelocities_, endSteps_;  ///< by row: of its ends, by the solutions and by the steps
  std::vector<btVector3> before_, stepped_;              ///< by row: u when the pass began, and by how much it changed
};

}  // namespace tetskin::bullet_detail
