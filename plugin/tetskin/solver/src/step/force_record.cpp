// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/step/recorded_forces.h>
#include <tetskin/solver/src/step/step.h>

#include <cassert>
#include <utility>

namespace tetskin {

ForceRecord::ForceRecord(std::shared_ptr<RecordedForces> recorded) : recorded_(std::move(recorded)) {
  assert(recorded_);
}

ForceRecord::~ForceRecord() = default;

Result<std::unique_ptr<ForceRecord>> ForceRecord::add(btDeformableMultiBodyDynamicsWorld& world) {
  DeformableSolver* solver = deformableSolverOf(world);
  if (!solver) return refusal("a record of forces", {kUseDeformableSolver});
  Access<DeformableSolver>::requireOwnSolve(*solver, world);
  auto& impl = Access<DeformableSolver>::impl(*solver);
  std::weak_ptr<RecordedForces>& inSolver = impl.recorded;
  std::shared_ptr<RecordedForces> recorded = inSolver.lock();
  if (!recorded) inSolver = recorded = std::make_shared<RecordedForces>(world);
  impl.recordDrawing.draw(recorded, world);
  return std::unique_ptr<ForceRecord>(new ForceRecord(std::move(recorded)));
}

AppliedForces ForceRecord::forcesOn(const btCollisionObject& object) const {
  return recorded_->on(object, nullptr);
}

AppliedForces ForceRecord::forcesBetween(const btCollisionObject& object, const btCollisionObject& other) const {
  return recorded_->on(object, &other);
}

}  // namespace tetskin
