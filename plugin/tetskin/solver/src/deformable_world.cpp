// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/motion/divided_limits.h>
#include <tetskin/solver/src/motion/rigid_forces.h>
#include <tetskin/solver/src/motion/rigid_turns.h>
#include <tetskin/solver/src/step/step.h>
#include <tetskin/solver/src/step/watched_detection.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {

using namespace bullet_detail;

namespace {

/// While this exists, the world is within `stepSimulation`; an exception that leaves it ends the step, too.
template <class SolverImpl>
class Simulation {
 public:
  Simulation(SolverImpl& solver, const btSoftBodyArray& bodies)
      : solver_(solver), bodies_(bodies), isInner_(solver.inSimulation), running_(solver.inSimulation) {}
  ~Simulation() {
    if (solver_.inStep() && !isInner_) solver_.endStep(bodies_);
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

 private:
  SolverImpl& solver_;
  const btSoftBodyArray& bodies_;
  const bool isInner_;  ///< called within a step, by a callback
  const Running running_;
};

}  // namespace

struct DeformableWorldObjects::Impl {
  Impl() : dispatcher(configuration, detects), broadphase(detects) {
    constraintSolver.setDeformableSolver(&deformableSolver);
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  bool detects = false;
  WatchedDispatcher dispatcher;
  WatchedBroadphase broadphase;
  DeformableSolver deformableSolver;
  btDeformableMultiBodyConstraintSolver constraintSolver;
  RigidTurns turns;
  std::unique_ptr<RigidForces> forces;  ///< null: Bullet's own treatment
};

DeformableWorldObjects::DeformableWorldObjects() : impl_(std::make_unique<Impl>()) {}
DeformableWorldObjects::~DeformableWorldObjects() = default;

DeformableWorld::DeformableWorld(const DeformableWorldOptions& options)
    : btDeformableMultiBodyDynamicsWorld(&impl_->dispatcher, &impl_->broadphase, &impl_->constraintSolver,
                                         &impl_->configuration, &impl_->deformableSolver) {
  Access<DeformableSolver>::impl(impl_->deformableSolver).know(*this);
  setGravity(options.gravity);
  setUseProjection(true);
  impl_->deformableSolver.setThreads(options.threads);
  impl_->deformableSolver.setDeterministic(options.deterministic);
  (void)impl_->deformableSolver.setSleepAfter(options.sleepAfter);
  Access<DeformableSolver>::impl(impl_->deformableSolver).impactParts = std::max(options.impactParts, 1);
  if (options.rigidForces == RigidForceModel::PlainWorld) {
    impl_->forces = std::make_unique<RigidForces>(m_nonStaticRigidBodies);
    Access<DeformableSolver>::impl(impl_->deformableSolver).rigidForces = impl_->forces.get();
  }
}

DeformableWorld::~DeformableWorld() = default;

/// Between the steps of one call, a world's state is incomplete: Bullet holds the number of steps left, and clears the
/// application's forces after the last one.
int DeformableWorld::stepSimulation(btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep) {
  const Simulation simulation(Access<DeformableSolver>::impl(impl_->deformableSolver), getSoftBodyArray());
  // Bullet would add it to its clock, or divide by it.
  if (!(timeStep >= 0 && timeStep < BT_LARGE_FLOAT) ||
      (maxSubSteps > 0 && !(fixedTimeStep > 0 && fixedTimeStep < BT_LARGE_FLOAT))) {
    return 0;
  }
  const btScalar seconds = maxSubSteps > 0 ? fixedTimeStep : timeStep;
  const btScalar more = maxSubSteps > 0 ? std::min(timeStep, static_cast<btScalar>(maxSubSteps - 1) * seconds) : 0;
  const int parts =
      Access<DeformableSolver>::impl(impl_->deformableSolver).partsOfSteps(*this, seconds, seconds + more);
  if (parts == 1 || timeStep == 0)
    return btDeformableMultiBodyDynamicsWorld::stepSimulation(timeStep, maxSubSteps, fixedTimeStep);
  const DividedLimits limits(*this, parts);
  // A time of exactly one step must include its last part, although rounding may have made the parts a little too long.
  constexpr btScalar kRounding = 4 * SIMD_EPSILON;
  const btScalar part = seconds / static_cast<btScalar>(parts) * (1 - kRounding);
  return btDeformableMultiBodyDynamicsWorld::stepSimulation(timeStep, std::max(maxSubSteps, 1) * parts, part);
}

DeformableSolver& DeformableWorld::deformableSolver() {
  return impl_->deformableSolver;
}
btDeformableMultiBodyConstraintSolver& DeformableWorld::constraintSolver() {
  return impl_->constraintSolver;
}
btDbvtBroadphase& DeformableWorld::broadphase() {
  return impl_->broadphase;
}
btCollisionDispatcher& DeformableWorld::dispatcher() {
  return impl_->dispatcher;
}

/// As btDeformableMultiBodyDynamicsWorld does; in a deterministic world, our own sine then turns the rigid bodies.
void DeformableWorld::predictUnconstraintMotion(btScalar dt) {
  btMultiBodyDynamicsWorld::predictUnconstraintMotion(dt);  // NOLINT(bugprone-parent-virtual-call): the soft ones below
  if (impl_->deformableSolver.deterministic()) RigidTurns::predict(m_nonStaticRigidBodies, dt);
  if (impl_->forces) impl_->forces->afterPrediction(dt);
  impl_->deformableSolver.predictMotion(dt);
}

/// See predictUnconstraintMotion.
void DeformableWorld::integrateTransforms(btScalar dt) {
  if (impl_->forces) impl_->forces->end();
  if (!impl_->deformableSolver.deterministic()) return btDeformableMultiBodyDynamicsWorld::integrateTransforms(dt);
  positionCorrection(dt);
  impl_->turns.begin(m_nonStaticRigidBodies);
  btMultiBodyDynamicsWorld::integrateTransforms(dt);  // NOLINT(bugprone-parent-virtual-call): as above
  impl_->turns.end(m_nonStaticRigidBodies, dt);
  impl_->deformableSolver.applyTransforms(dt);
}

}  // namespace tetskin
