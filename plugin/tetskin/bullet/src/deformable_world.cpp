// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <tetskin/bullet/deformable_world.h>
#include <tetskin/bullet/src/motion/rigid_turns.h>
#include <tetskin/bullet/src/step/step.h>
#include <tetskin/bullet/src/step/watched_detection.h>

namespace tetskin {

using namespace bullet_detail;

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
};

DeformableWorldObjects::DeformableWorldObjects() : impl_(std::make_unique<Impl>()) {}
DeformableWorldObjects::~DeformableWorldObjects() = default;

DeformableWorld::DeformableWorld(const DeformableWorldOptions& options)
    : btDeformableMultiBodyDynamicsWorld(&impl_->dispatcher, &impl_->broadphase, &impl_->constraintSolver,
                                         &impl_->configuration, &impl_->deformableSolver) {
  setGravity(options.gravity);
  setUseProjection(true);
  impl_->deformableSolver.setThreads(options.threads);
  impl_->deformableSolver.setDeterministic(options.deterministic);
}

DeformableWorld::~DeformableWorld() = default;

/// Between the steps of one call, a world is in no state of its own: Bullet knows how many steps are left, and clears
/// the application's forces after the last one.
int DeformableWorld::stepSimulation(btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep) {
  const Running simulation(impl_->deformableSolver.impl_->inSimulation);
  return btDeformableMultiBodyDynamicsWorld::stepSimulation(timeStep, maxSubSteps, fixedTimeStep);
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

/// As of btDeformableMultiBodyDynamicsWorld, with turns by our own sine after Bullet's.
void DeformableWorld::predictUnconstraintMotion(btScalar dt) {
  if (!impl_->deformableSolver.deterministic()) {
    return btDeformableMultiBodyDynamicsWorld::predictUnconstraintMotion(dt);
  }
  btMultiBodyDynamicsWorld::predictUnconstraintMotion(dt);  // NOLINT(bugprone-parent-virtual-call): in place of its own
  RigidTurns::predict(m_nonStaticRigidBodies, dt);
  impl_->deformableSolver.predictMotion(dt);
}

/// As of btDeformableMultiBodyDynamicsWorld, likewise.
void DeformableWorld::integrateTransforms(btScalar dt) {
  if (!impl_->deformableSolver.deterministic()) return btDeformableMultiBodyDynamicsWorld::integrateTransforms(dt);
  positionCorrection(dt);
  impl_->turns.begin(m_nonStaticRigidBodies);
  btMultiBodyDynamicsWorld::integrateTransforms(dt);  // NOLINT(bugprone-parent-virtual-call): as above
  impl_->turns.end(m_nonStaticRigidBodies, dt);
  impl_->deformableSolver.applyTransforms(dt);
}

}  // namespace tetskin
