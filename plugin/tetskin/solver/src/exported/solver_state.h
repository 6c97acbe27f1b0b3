// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For other libraries: what a DeformableSolver, its forces and its search for contacts remember, and which of their
// classes a world contains. Snapshots see nothing else of it.
#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/deformable_world.h>

namespace tetskin::bullet_detail {

// Each of these serves both directions. Data that is only prepared, or recomputed in each step, is in none of them.
/// What the solver remembers from step to step.
TETSKIN_SOLVER_API void serializeSolver(WorldStream& stream, DeformableSolver& solver);
/// The application's settings of the solver: not part of a snapshot.
TETSKIN_SOLVER_API void serializeSolverSettings(WorldStream& stream, DeformableSolver& solver);
/// The entries of the solver's list of forces: elasticity, soft contacts, joints at surfaces.
TETSKIN_SOLVER_API void serializeForces(WorldStream& stream, DeformableSolver& solver);
/// Call it before the others: checks the solver's bodies and forces. Refuses what cannot be saved and, while a snapshot
/// is restored, a world that differs.
TETSKIN_SOLVER_API void checkForces(WorldStream& stream, DeformableSolver& solver);
/// State of the search for contacts of soft bodies with rigid objects.
TETSKIN_SOLVER_API void serializeContactSearch(WorldStream& stream);

/// Parts of a world, as samples of Bullet's classes. They are made in this library, as those of a `DeformableWorld`
/// are: if each library contains a Bullet of its own, its classes have other virtual tables than those of other
/// libraries.
class WorldParts {
 public:
  static TETSKIN_SOLVER_API WorldParts& get();

 private:
  static btDefaultCollisionConstructionInfo small();
  WorldParts() = default;
  btDefaultCollisionConfiguration configuration_{small()};

 public:
  btCollisionDispatcher dispatcher{&configuration_};
  btDbvtBroadphase broadphase;
  btDeformableMultiBodyConstraintSolver solver;
};

/// True for the broadphase, and for the dispatcher, of a `DeformableWorld`.
TETSKIN_SOLVER_API bool isWatched(const btBroadphaseInterface& broadphase);
TETSKIN_SOLVER_API bool isWatched(const btDispatcher& dispatcher);
/// True for the library's only action, which draws recorded forces and has no state.
TETSKIN_SOLVER_API bool drawsRecords(const btActionInterface& action);

}  // namespace tetskin::bullet_detail
