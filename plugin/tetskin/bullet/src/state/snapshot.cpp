// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/deformable_world.h>
#include <tetskin/bullet/src/base/required_solver.h>
#include <tetskin/bullet/src/state/world_state.h>

namespace tetskin {

using namespace bullet_detail;

namespace {

/// All parts, in their order.
void visitWorld(WorldStream& stream, DeformableSolver& solver) {
  if (stream.restoring()) removePairs(stream);
  visitObjects(stream);
  visitSoftBodies(stream);
  visitJoints(stream);
  visitBroadphase(stream);
  visitPairs(stream);
  visitSolver(stream, solver);
  visitContactSearch(stream);
  visitForces(stream, solver);
}

}  // namespace

Result<std::size_t> saveSnapshot(const btDeformableMultiBodyDynamicsWorld& world, void* buffer, std::size_t size) {
  auto& saved = const_cast<btDeformableMultiBodyDynamicsWorld&>(world);  // NOLINT: Bullet has no const accessors
  DeformableSolver* solver = deformableSolverOf(saved);
  if (!solver) return refusal("a snapshot", {kUseDeformableSolver});
  auto* bytes = static_cast<unsigned char*>(buffer);
  WorldStream stream = bytes ? WorldStream(saved, bytes, size) : WorldStream(saved);
  visitWorld(stream, *solver);
  return stream.count();
}

Status restoreSnapshot(btDeformableMultiBodyDynamicsWorld& world, const void* snapshot, std::size_t size) {
  DeformableSolver* solver = deformableSolverOf(world);
  if (!solver) return refusal("a snapshot", {kUseDeformableSolver});
  WorldStream stream(world, static_cast<const unsigned char*>(snapshot), size);
  visitWorld(stream, *solver);
  return {};
}

Result<std::size_t> DeformableWorld::save(void* buffer, std::size_t size) const {
  return saveSnapshot(*this, buffer, size);
}

Status DeformableWorld::restore(const void* snapshot, std::size_t size) {
  return restoreSnapshot(*this, snapshot, size);
}

}  // namespace tetskin
