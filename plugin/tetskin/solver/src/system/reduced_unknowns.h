// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SystemSolve: the reduced unknowns of a system, V of rigid bodies followed by q of the components of stiff
// bodies. They are eliminated from the nodes' equations, and are computed from the nodes' velocities afterwards.
#pragma once

#include <tetskin/solver/src/system/component_unknown.h>
#include <tetskin/solver/src/system/schur_complement.h>
#include <tetskin/solver/src/system/system_bodies.h>

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tetskin::bullet_detail {

using EndVelocities = std::array<btVector3, 2>;

/// The derivative, along a pass's step, of the energy that the solve minimizes: linear + fraction * quadratic.
struct Slope {
  double linear = 0.0, quadratic = 0.0;
};

/// A pass takes them through three stages, each of which is asserted by the next:
///   findResidual, eliminate, and `move` with `takeBack`; or `settle` in place of these two.
class ReducedUnknowns {
 public:
  using Vector = Eigen::VectorXd;

  /// Moves the rigid motions of components out of the bodies' solutions into the unknowns.
  explicit ReducedUnknowns(SystemBodies& bodies);

  bool empty() const { return size_ == 0; }
  const std::vector<ComponentUnknown>& components() const { return components_; }
  /// True if they move an end of the row.
  bool couples(std::size_t row) const { return firstOf(row, 0) >= 0 || firstOf(row, 1) >= 0; }
  /// The velocity that they give a row, and that a change of them gives it.
  btVector3 velocity(std::size_t row) const { return velocityBy(row, unknowns_); }
  btVector3 velocityBy(std::size_t row, const Vector& change) const;
  /// The square of a component's velocities, with respect to the masses, when the pass began.
  double squaredByMasses(const ComponentUnknown& component) const;
  Slope slopeOfRigids() const;
  void addSlopeOfComponents(Slope& to) const;

  /// Computes what the body's solution means for its components.
  void readSolution(const SystemBody& body);
  /// Takes the components' part out of a residual of the nodes.
  void addImages(const SystemBody& body) const;

  // ---- A pass.
  /// The momentum that is left, by the rows' impulses.
  void findResidual();
  /// Makes the residual of the nodes, with rows, agree with that of the components.
  void matchComponents(const SystemBody& body) const;
  /// Takes the unknowns out of the nodes' equations, which have the rows' tangents by then.
  void eliminate();
  /// The square of their residual's norm.
  double squaredResidual() const;
  /// Computes the unknowns from the nodes' change in the pass.
  /// steps  by row: the change of its velocity by its nodes
  void move(const std::vector<btVector3>& steps);
  /// Keeps the momentum that this has given to rigid bodies.
  /// steps  by row: the change of its velocity by nodes and unknowns
  void takeBack(const std::vector<btVector3>& steps);
  /// Leaves this fraction of the pass's step.
  void moveBack(btScalar fraction);
  /// Ends the solve in a pass that does not move: the residual that is left is small in terms of velocity, but with
  /// stiff rows its impulses need not be small. The few unknowns take them up, so that momentum agrees with the rows'
  /// impulses while velocities hardly change.
  void settle();

  /// Moves the components' motions back into the body's solution.
  void moveOut(const SystemBody& body) const;
  /// Adds the sum of the rows' impulses to rigid bodies, in Bullet.
  void apply() const;

  // ---- Products, once the unknowns are eliminated.
  /// The change of the unknowns by a step of the nodes.
  /// images    of components: Z^T A times the step;  endSteps  by row: of its ends
  Vector changeBy(const Vector& images, const std::vector<EndVelocities>& endSteps) const;
  /// Adds the effect of changes of the unknowns on the body's nodes.
  /// endSteps  adds that of these steps of the rows' other ends, too; null: not
  /// to        in the wide layout: residuals or products
  void addEffect(const SystemBody& body, const Vector& change, btScalar sign,
                 const std::vector<EndVelocities>* endSteps, btScalar* to) const;
  /// A vector of all unknowns, 0.
  Vector zeros() const;
  /// Writes a component's Z^T A times a vector in the wide layout.
  void setImages(const SystemBody& body, const btScalar* wide, Vector& to) const;

 private:
  /// How far a pass is.
  enum class Stage { Current, Residual, Eliminated, Moved };

  void numberRigids();
  void collectComponents();
  void findEndMotions(const SystemBody& body);
  void couple();
  void moveIn(const SystemBody& body);
  Eigen::Index firstOf(std::size_t row, std::size_t end) const;
  bool needsComponents(const SystemBody& body) const;
  bool isJoined(const SystemBody& body) const;
  bool isOnComponent(std::size_t row, std::size_t end) const { return componentOf_[row][end] != nullptr; }
  bool hasRowMotions(std::size_t row, std::size_t end) const;
  RowMotions rowMotions(std::size_t row, std::size_t end) const;
  RigidUnknowns::Jacobian jacobianOf(std::size_t row, std::size_t end) const;
  Small6 momentumOf(const ComponentUnknown& component) const;
  void findStiffness();
  void addStiffness(std::size_t row, std::size_t a, std::size_t b, const Small3x3& h);
  void addPush(std::size_t row, const btVector3& push, Vector& to) const;
  void addPushes(const std::vector<btVector3>& steps, Vector& to) const;
  /// Calls call(component) for those of a body.
  template <class Call>
  void forComponents(const SystemBody& body, Call&& call) const {
    const auto& [first, last] = componentsOf_[body.solved.solve.place];
    for (std::size_t c = first; c < last; ++c) call(components_[c]);
  }

  SystemBodies& bodies_;
  RigidUnknowns& rigids_;
  std::vector<ComponentUnknown> components_;
  std::vector<std::pair<std::size_t, std::size_t>> componentsOf_;  ///< by body: first and last in `components_`
  /// By row and end: the component on which the end acts, null where its rigid motion is no separate unknown; and Z at
  /// the end's point.
  std::vector<std::array<const ComponentUnknown*, 2>> componentOf_;
  std::vector<std::array<RowMotions, 2>> motionsOf_;
  std::vector<std::size_t> rows_;  ///< those with an end that they move, ascending
  Eigen::Index rigidSize_ = 0, size_ = 0;
  Stage stage_ = Stage::Current;
  SchurComplement schurComplement_;
  Vector unknowns_, step_, residual_;  ///< their values; in the pass, their change and the residual of their equations
  Vector images_, imagesBefore_;       ///< of components: Z^T A y, now and when the pass began
  Vector momentaBefore_;               ///< of components, when the pass began
  Vector rigidMomentum_, rigidPush_;   ///< M V, and its change in the pass
};

/// What is added to the products of the bodies' matrices, which contain the blocks of each end of a row with itself:
/// what couples the bodies, rows between two of them, the reduced unknowns, and other forces.
class CoupledProducts final : public elastic_detail::ConjugateGradient<btScalar>::CouplingOperator {
 public:
  CoupledProducts(const SystemBodies& bodies, const ReducedUnknowns& reduced);
  /// Begins a pass, in which these bodies move.
  /// moving  ascending
  void begin(std::vector<std::size_t> moving);

  /// Computes the velocities that a body's step gives the rows' ends, and its images.
  void readPoints(std::size_t k) override;
  void combine() override;
  const btScalar* apply(std::size_t k) override;

 private:
  const SystemBodies& bodies_;
  const ReducedUnknowns& reduced_;
  std::vector<std::size_t> moving_;      ///< numbers in SystemBodies
  std::vector<EndVelocities> endSteps_;  ///< by row
  Eigen::VectorXd images_;               ///< of components: Z^T A times the step of the conjugate gradient
  Eigen::VectorXd change_;               ///< of the reduced unknowns by this step
};

}  // namespace tetskin::bullet_detail
