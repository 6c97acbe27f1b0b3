// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin: tests whether a world has the solver that corotated bodies, contacts and joints need.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/base/node_loads.h>
#include <tetskin/solver/src/base/placement.h>

#include <functional>
#include <string>
#include <vector>

namespace tetskin::bullet_detail {

/// Message for an application whose world has another solver.
constexpr const char* kUseDeformableSolver =
    "create the world and its constraint solver with a DeformableSolver in place of Bullet's";

/// The solver as a DeformableSolver; null if it is another class.
TETSKIN_SOLVER_API DeformableSolver* deformableSolver(btSoftBodySolver* solver);
/// The solver of the body's world; null if the body is in none, or its world has another solver.
TETSKIN_SOLVER_API DeformableSolver* deformableSolverOf(const btSoftBody& body);

/// The solver of any deformable world. Bullet reveals it to bodies only; adding one would change the ids of others.
TETSKIN_SOLVER_API btDeformableBodySolver& solverOf(btDeformableMultiBodyDynamicsWorld& world);
/// Null if the world has another solver.
TETSKIN_SOLVER_API DeformableSolver* deformableSolverOf(btDeformableMultiBodyDynamicsWorld& world);

/// True within a step, and between the steps of a `stepSimulation`: the state of the world is not complete.
TETSKIN_SOLVER_API bool isWithinStep(const DeformableSolver& solver);

/// Ok if nothing needs to be changed; otherwise InvalidOption, with a message that lists everything that must be.
/// subject  what was requested: "surface contact"
TETSKIN_SOLVER_API Status refusal(const std::string& subject, const std::vector<std::string>& changes);

}  // namespace tetskin::bullet_detail

namespace tetskin {

template <>
struct Access<DeformableSolver> {
  /// What only the library sees: see step.h.
  static DeformableSolver::Impl& impl(const DeformableSolver& solver);
  /// `requireOwnSolve` of a world's solver. The solver knows the world from then on, and can tell during a step which
  /// objects are in it.
  static TETSKIN_SOLVER_API void requireOwnSolve(DeformableSolver& solver, btDeformableMultiBodyDynamicsWorld& world);
  /// Applies forces in the next steps. Wakes the body, which is in the solver's world.
  /// forces  world space, mass times length / s^2
  /// steps   1 or more
  static TETSKIN_SOLVER_API void addLoads(DeformableSolver& solver, btSoftBody& body, bullet_detail::NodePushes forces,
                                          int steps);
  /// Forgets all that the solver remembers of a body, including loads that act on it for a number of steps. Not within
  /// a step.
  static void reset(DeformableSolver& solver, btSoftBody& body);
  /// Forgets a body's contacts and its sleep history; moves its driven nodes along. Not within a step.
  /// moveNodes  moves the nodes of the body
  static void teleport(DeformableSolver& solver, btSoftBody& body, const bullet_detail::Placement& placement,
                       const std::function<void()>& moveNodes);
  /// Moves everything in the world. Not within a step.
  static void shift(DeformableSolver& solver, btDeformableMultiBodyDynamicsWorld& world, const btVector3& by);
};

}  // namespace tetskin
