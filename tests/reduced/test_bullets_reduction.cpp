// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The behaviour of Bullet's own reduced bodies. The library's reduced bodies are based on these; see ReducedBodies,
// ReducedMotion.
#include "reduced_test.h"

namespace tetskin {
namespace {

using namespace test;

/// The same body made without the library's class.
std::unique_ptr<btReducedDeformableBody> bullets(World& world, const VibrationModes& modes,
                                                 const ReducedBodyOptions& options) {
  World scratch;
  ReducedBodyOptions atRest = options;
  atRest.placement.setIdentity();
  const auto made = added(scratch, modes, atRest);
  const btReducedDeformableBody& from = made->body();
  std::vector<btVector3> nodes;
  for (int n = 0; n < from.m_nodes.size(); ++n) nodes.push_back(options.placement * from.m_nodes[n].m_x);
  auto body = std::make_unique<btReducedDeformableBody>(&world.world->getWorldInfo(), static_cast<int>(nodes.size()),
                                                        nodes.data(), nullptr);
  for (const auto& f : boundaryFaces(barCage().mesh)) body->appendFace(f[0], f[1], f[2]);
  body->setReducedModes(from.m_nReduced, from.m_nFull);
  body->m_modes.copyFromArray(from.m_modes);
  body->m_eigenvalues.copyFromArray(from.m_eigenvalues);
  body->m_Kr.copyFromArray(from.m_Kr);
  body->setMassProps(from.m_nodalMass);
  body->setInertiaProps();
  body->internalInitialization();
  body->getCollisionShape()->setMargin(btScalar(0.02));
  body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
  body->m_cfg.kKHR = body->m_cfg.kCHR = 1;
  world.world->addSoftBody(body.get());
  return body;
}

TEST(BulletsReduction, LetsSleepingBodiesFall) {
  World world;
  const auto body = bullets(world, barModes(), barOptions());
  const double before = lowest(*body);
  body->forceActivationState(ISLAND_SLEEPING);
  world.step(120);
  EXPECT_FALSE(body->isActive());
  EXPECT_LT(lowest(*body), before - 1.0);
  world.world->removeSoftBody(body.get());

  World other;
  const auto ours = added(other, barModes());
  ours->body().forceActivationState(ISLAND_SLEEPING);
  other.step(120);
  EXPECT_FALSE(ours->body().isActive());
  EXPECT_NEAR(lowest(ours->body()), before, 1e-6);
}

TEST(BulletsReduction, NeverSleeps) {
  World world;
  world.addFloor();
  const auto body = bullets(world, barModes(), fewModes(at(0, 0.3, 0)));
  body->setDamping(0, btScalar(0.001));
  world.step(2400);
  EXPECT_TRUE(allFinite(*body));
  EXPECT_TRUE(body->isActive());
  world.world->removeSoftBody(body.get());
}

/// A body of a few nodes, far to the left.
std::unique_ptr<ReducedBody> smallBody(World& world) {
  const TetMesh small = makeBox({3, 2, 2}, Eigen::Vector3d(0.6, 0.4, 0.4));
  VibrationOptions few;
  few.modeCount = 4;
  ReducedBodyOptions options = barOptions(at(-9, 0.5, 0));
  options.skipFastModes = true;
  auto body = ReducedBody::add(*world.world, computeVibrationModes(small, few).value(), small, options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

double largestDistance(const btSoftBody& a, const btSoftBody& b) {
  double largest = 0.0;
  for (int n = 0; n < a.m_nodes.size(); ++n) largest = std::max(largest, (nodeOf(a, n) - nodeOf(b, n)).norm());
  return largest;
}

TEST(BulletsReduction, TouchesOtherNodesOfABodyThatCameAfterASmallerOne) {
  // The body is tilted, so that one edge lands first.
  const btTransform tilted(btQuaternion(btVector3(0, 0, 1), btScalar(0.3)), btVector3(0, btScalar(0.8), 0));
  constexpr int kSubsteps = 120;
  World alone, beside;
  alone.addFloor();
  beside.addFloor();
  const auto other = smallBody(beside);
  const auto first = bullets(alone, barModes(), fewModes(tilted)),
             second = bullets(beside, barModes(), fewModes(tilted));
  alone.step(kSubsteps);
  beside.step(kSubsteps);
  EXPECT_GT(largestDistance(*first, *second), 0.01);
  alone.world->removeSoftBody(first.get());
  beside.world->removeSoftBody(second.get());

  const auto oursAlone = added(alone, barModes(), fewModes(tilted)), ours = added(beside, barModes(), fewModes(tilted));
  alone.step(kSubsteps);
  beside.step(kSubsteps);
  EXPECT_LT(largestDistance(oursAlone->body(), ours->body()), 1e-3);
}

TEST(BulletsReduction, ExplodesByItsDamping) {
  World world(btVector3(0, 0, 0));
  const auto body = bullets(world, barModes(), barOptions());
  body->setDamping(0, 1);
  body->m_reducedVelocityBuffer[19] = btScalar(0.1);
  world.step(240);
  EXPECT_FALSE(allFinite(*body));
  world.world->removeSoftBody(body.get());
}

TEST(BulletsReduction, DoesNotBendByGravityWhatIsHeld) {
  World world;
  const auto body = bullets(world, barModes(true), barOptions());
  world.step(120);
  for (int r = 0; r < body->m_nReduced; ++r) EXPECT_EQ(body->m_reducedDofs[r], 0);  // the body falls
  world.world->removeSoftBody(body.get());
}

TEST(BulletsReduction, TakesTheBentShapeForTheRestShapeWhenItIsMoved) {
  World world(btVector3(0, 0, 0));
  const auto body = bullets(world, barModes(), barOptions());
  const btVector3 rest = body->m_nodes[0].m_x;
  body->m_reducedVelocityBuffer[0] = 1;
  world.step(10);
  const btVector3 bent = body->m_nodes[0].m_x - rest;
  body->transform(btTransform::getIdentity());
  body->updateLocalMomentArm();
  body->mapToFullPosition(body->getRigidTransform());
  EXPECT_GT((body->m_nodes[0].m_x - rest).length(), 1.9 * bent.length());
  world.world->removeSoftBody(body.get());
}

TEST(BulletsReduction, FloatsInAWorldWhoseGravityWasNeverSet) {
  World world;
  btReducedDeformableBodySolver fresh;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btDeformableMultiBodyConstraintSolver constraints;
  constraints.setDeformableSolver(&fresh);
  btDeformableMultiBodyDynamicsWorld silent(&dispatcher, &broadphase, &constraints, &configuration, &fresh);
  const auto body = std::move(ReducedBody::add(silent, barModes(), barCage(), barOptions())).value();
  const double before = lowest(body->body());
  for (int k = 0; k < 60; ++k) silent.stepSimulation(btScalar(1) / 240, 0);
  EXPECT_LT(silent.getGravity().y(), -9);
  EXPECT_EQ(lowest(body->body()), before);
}

}  // namespace
}  // namespace tetskin
