// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/saved_worlds.h>
#include <tetskin/replay/src/state/world_state.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/exported/solver_state.h>

#include <string>

namespace tetskin::bullet_detail {

using World = btDeformableMultiBodyDynamicsWorld;

using ActionsMember = Hidden<btDiscreteDynamicsWorld, btAlignedObjectArray<btActionInterface*>>;
template struct Opened<ActionsMember, &btDiscreteDynamicsWorld::m_actions>;

namespace {

bool isSavedBroadphase(const btBroadphaseInterface& broadphase) {
  return isWatched(broadphase) || isOfSameClass<btBroadphaseInterface>(broadphase, WorldParts::get().broadphase);
}

bool isSavedDispatcher(const btDispatcher& dispatcher) {
  return isWatched(dispatcher) || isOfSameClass<btDispatcher>(dispatcher, WorldParts::get().dispatcher);
}

bool isSavedSolver(const btConstraintSolver& solver) {
  return isOfSameClass<btConstraintSolver>(solver, WorldParts::get().solver);
}

bool isSavedCache(const btOverlappingPairCache& cache) {
  return isOfSameClass(cache, *WorldParts::get().broadphase.getOverlappingPairCache());
}

std::string unsavedPart(World& world) {
  if (!isSavedBroadphase(*world.getBroadphase())) return "a broadphase that is not a btDbvtBroadphase";
  if (!isSavedCache(*world.getPairCache())) return "a pair cache that is not a btHashedOverlappingPairCache";
  if (!isSavedDispatcher(*world.getDispatcher())) return "a dispatcher that is not a btCollisionDispatcher";
  if (!isSavedSolver(*world.getConstraintSolver())) {
    return "a constraint solver that is not a btDeformableMultiBodyConstraintSolver";
  }
  const auto& actions = world.*memberOf(ActionsMember());
  for (int k = 0; k < actions.size(); ++k) {
    if (!drawsRecords(*actions[k])) return "action " + std::to_string(k) + " (a vehicle, a character, or your own)";
  }
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  constexpr int kSaved = btCollisionObject::CO_COLLISION_OBJECT | btCollisionObject::CO_RIGID_BODY |
                         btCollisionObject::CO_SOFT_BODY | btCollisionObject::CO_FEATHERSTONE_LINK;
  for (int k = 0; k < objects.size(); ++k) {
    if (objects[k]->getInternalType() & ~kSaved)
      return "object " + std::to_string(k) + " (a ghost object, or your own)";
    if (!objects[k]->getCollisionShape() || !objects[k]->getBroadphaseHandle()) {
      return "object " + std::to_string(k) + " (it has no collision shape, or the world's broadphase does not know it)";
    }
  }
  for (int k = 0; k < world.getNumConstraints(); ++k) {
    if (!isSaved(*world.getConstraint(k))) return "joint " + std::to_string(k) + " (none of Bullet's classes)";
  }
  for (int k = 0; k < world.getNumMultiBodyConstraints(); ++k) {
    if (!isSaved(*world.getMultiBodyConstraint(k))) {
      return "joint of multibodies " + std::to_string(k) + " (none of Bullet's classes)";
    }
  }
  return "";
}

}  // namespace

Status checkIsSaved(World& world, const DeformableSolver& solver) {
  if (isWithinStep(solver))
    return {StatusCode::NotSaved, "a snapshot has no world within a step: wait until stepSimulation ends"};
  const std::string part = unsavedPart(world);
  if (part.empty()) return {};
  return {StatusCode::NotSaved, "a snapshot cannot hold " + part};
}

}  // namespace tetskin::bullet_detail
