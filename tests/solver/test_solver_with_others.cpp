// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Other objects in a world of the library's solver: they behave as with Bullet's solver.
#include "cloth.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace tetskin::test {
namespace {

double largestDifference(const btSoftBody& a, const btSoftBody& b) {
  btScalar maximum = 0;
  for (int n = 0; n < a.m_nodes.size(); ++n)
    maximum = std::max(maximum, (a.m_nodes[n].m_x - b.m_nodes[n].m_x).length());
  return static_cast<double>(maximum);
}

TEST(SolverWithOthers, ClothHangsAsWithBulletsSolver) {
  TetskinWorld ours;
  EmptyWorld bullets;
  const auto beside = added(ours, smallCageAbove(8));
  Cloth a(ours), b(bullets);
  double swung = 0.0;
  for (int f = 0; f < 60; ++f) {
    step(ours, 1);
    step(bullets, 1);
    swung = std::max(swung, 3.0 - lowest(*b.body));
    ASSERT_LT(largestDifference(*a.body, *b.body), 0.01) << "frame " << f;
  }
  EXPECT_GT(swung, 0.5);
}

TEST(SolverWithOthers, BulletsMaterialsLandAsWithBulletsSolver) {
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::LinearElasticity}) {
    TetskinWorld ours;
    EmptyWorld bullets;
    SoftBodyOptions options;
    options.forceModel = model;
    const auto beside = added(ours, smallCageAbove(8));
    const auto a = added(ours, cageAbove(0.3), options), b = added(bullets, cageAbove(0.3), options);
    for (int f = 0; f < 40; ++f) {
      step(ours, 1);
      step(bullets, 1);
      ASSERT_LT(largestDifference(a->body(), b->body()), 0.01) << "frame " << f;
    }
    step(ours, 140);
    EXPECT_LT(rmsSpeed(a->body()), 0.05);
    EXPECT_GT(lowest(a->body()), -0.01);
  }
}

TEST(SolverWithOthers, BodiesOfAllKindsLandInImplicitWorlds) {
  for (const bool lineSearch : {false, true}) {
    TetskinWorld world;
    world.deformable().setImplicit(true);
    world.deformable().setLineSearch(lineSearch);
    SoftBodyOptions options;
    options.forceModel = ForceModel::NeoHookean;
    const auto a = added(world, cageAbove(0.3)), b = added(world, smallCageAbove(2.5), options);
    // Bullet's line search reads past the end of an array where a neo-Hookean body sleeps.
    b->body().setActivationState(DISABLE_DEACTIVATION);
    EXPECT_EQ(a->solverPath(), SolverPath::Solver);
    step(world, 1);
    EXPECT_EQ(a->solverPath(), SolverPath::Solver);
    step(world, 11);
    EXPECT_NEAR(static_cast<double>(centreOf(b->body()).y()), 2.8 - 0.5 * 10.0 * 0.2 * 0.2, 0.02);
    step(world, 168);
    EXPECT_LT(rmsSpeed(a->body()), 0.1) << lineSearch;
    EXPECT_GT(lowest(a->body()), -0.01);
    EXPECT_LT(lowest(a->body()), 0.1);
  }
}

/// The world's setting becomes known in its first step, only after the solver has been asked to begin that step.
TEST(SolverWithOthers, WorldsWithoutProjectionKeepTheirRigidBodies) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.configureWorld = false;
  world.deformable().setUseProjection(false);
  const auto body = added(world, cageAbove(0.01), options);
  btBoxShape shape(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3)));
  btVector3 inertia;
  shape.calculateLocalInertia(btScalar(0.1), inertia);
  btRigidBody box(btScalar(0.1), nullptr, &shape, inertia);
  btTransform above(btQuaternion::getIdentity(), btVector3(btScalar(0.5), btScalar(0.9), btScalar(0.5)));
  box.setWorldTransform(above);
  box.setInterpolationWorldTransform(above);
  world.deformable().addRigidBody(&box);
  step(world, 10);
  EXPECT_TRUE(std::isfinite(box.getWorldTransform().getOrigin().length()));
  world.deformable().removeRigidBody(&box);
}

}  // namespace
}  // namespace tetskin::test
