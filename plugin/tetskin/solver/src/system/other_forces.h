// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what forces other than elasticity, Bullet's and the application's, add to the equations
// of a system.
#pragma once

#include <tetskin/solver/src/rows/solver_bodies.h>

#include <vector>

namespace tetskin::bullet_detail {

class OtherForces {
 public:
  /// Call it before the systems of a step are solved.
  /// impulses  of these forces, by node number; must stay valid until the step ends
  /// before    by node number: velocities before Bullet's solve of contacts; must stay valid, too
  void beginStep(const SolverBodies& bodies, const VectorStack& impulses, const VectorStack& before, btScalar seconds);

  /// Computes what the forces add to the matrices' products with the current solutions.
  void multiplySolutions(const SolvedSystem& system);
  /// Computes what they add to the matrices' products with their steps.
  void multiplySteps(const SolvedSystem& system);
  /// Adds to a body's residual the effect of other forces; where any act on the system, after `multiplySolutions`.
  /// body  index in SolverBodies::bodies
  void addResiduals(const SolvedSystem& system, std::size_t body) const;

  /// Of a body, in the wide layout: what was last computed.
  std::vector<btScalar>& products(std::size_t body) { return products_[body]; }
  const btVector3& impulse(int number) const { return (*impulses_)[number]; }

 private:
  void multiply(const SolvedSystem& system);

  const std::vector<SolvedBody>* bodies_ = nullptr;
  const VectorStack *impulses_ = nullptr, *before_ = nullptr;
  btScalar seconds_ = 0;
  VectorStack factor_, image_;                   ///< by node number
  std::vector<std::vector<btScalar>> products_;  ///< by body
};

}  // namespace tetskin::bullet_detail
