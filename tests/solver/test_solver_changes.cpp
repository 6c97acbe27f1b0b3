// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Changes between steps and during them: bodies that sleep and wake, are added and removed, or get other nodes and
// sizes.
#include "cloth.h"

namespace tetskin::test {
namespace {

TEST(SolverWithOthers, SleepersStayWhereTheyAreAndWake) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.relativeStiffness = 300.0;
  options.stiffnessDamping = 0.1;
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  for (int b = 0; b < 6; ++b) {
    TetMesh cage = smallCageAbove(0.02);
    for (Eigen::Vector3d& p : cage.nodes) p.x() += 3.0 * b;
    bodies.push_back(added(world, cage, options));
  }
  const auto asleep = [&] {
    return std::count_if(bodies.begin(), bodies.end(), [](const auto& body) { return !body->body().isActive(); });
  };
  std::vector<btVector3> before;
  btScalar jump = 0;
  int frames = 0;
  while (asleep() < 6 && ++frames < 1200) {
    before.clear();
    for (const auto& body : bodies) before.push_back(body->body().m_nodes[0].m_x);
    step(world, 1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!bodies[b]->body().isActive()) jump = std::max(jump, (bodies[b]->body().m_nodes[0].m_x - before[b]).length());
    }
  }
  ASSERT_EQ(asleep(), 6) << "after " << frames << " frames";
  EXPECT_LT(jump, btScalar(1e-3));
  step(world, 1);
  EXPECT_EQ(world.bodySolver().iterations(), 0);
  const btVector3 still = bodies[3]->body().m_nodes[5].m_x;
  step(world, 30);
  EXPECT_EQ((bodies[3]->body().m_nodes[5].m_x - still).length(), btScalar(0));

  bodies[3]->body().activate();
  bodies[3]->body().setVelocity(btVector3(0, 3, 0));
  step(world, 6);
  EXPECT_GT(lowest(bodies[3]->body()), 0.1);
  EXPECT_EQ(asleep(), 5);
}

TEST(SolverWithOthers, FollowsABodyThatIsScaled) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(50));
  step(world, 2);
  body->body().scale(btVector3(2, 2, 2));
  step(world, 40);
  btScalar low = 1e9f, high = -1e9f;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    low = std::min(low, body->body().m_nodes[n].m_x.z());
    high = std::max(high, body->body().m_nodes[n].m_x.z());
  }
  EXPECT_NEAR(static_cast<double>(high - low), 2 * 0.9, 0.01);
}

/// Bullet's tets dangle after `appendNode`: the solver no longer steps the body, says so, and reads nothing past its
/// end.
TEST(SolverWithOthers, SurvivesNodesThatAreAppended) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(5));
  step(world, 2);
  body->body().appendNode(btVector3(0, 9, 0), btScalar(0.1));
  body->body().m_tetras.resize(0);  // otherwise Bullet itself reads through them
  EXPECT_EQ(body->solverPath(), SolverPath::Solver);
  step(world, 5);
  EXPECT_TRUE(std::isfinite(rmsSpeed(body->body())));
  EXPECT_EQ(body->solverPath(), SolverPath::None);
}

TEST(SolverWithOthers, BodiesMayGoInBulletsCallbacks) {
  for (const bool afterSolve : {false, true}) {
    TetskinWorld world;
    struct Bodies {
      std::vector<std::unique_ptr<DeformableBody>> all;
      int calls = 0;
      static void goes(btScalar, btDeformableMultiBodyDynamicsWorld* in) {
        auto& bodies = *static_cast<Bodies*>(in->getWorldUserInfo());
        if (++bodies.calls == 8) bodies.all.erase(bodies.all.begin());
      }
    } bodies;
    for (int b = 0; b < 3; ++b) bodies.all.push_back(added(world, cageAbove(0.021 + 1.5 * b)));
    world.deformable().setWorldUserInfo(&bodies);
    if (afterSolve) {
      world.deformable().setSolverCallback(Bodies::goes);  // called before and after the solve
    } else {
      const auto tick = [](btDynamicsWorld* in, btScalar) {
        Bodies::goes(0, static_cast<btDeformableMultiBodyDynamicsWorld*>(in));
      };
      world.deformable().setInternalTickCallback(tick, &bodies, false);
    }
    step(world, 30);
    EXPECT_EQ(bodies.all.size(), 2u);
    for (const auto& body : bodies.all) EXPECT_TRUE(std::isfinite(rmsSpeed(body->body())));
    world.deformable().setSolverCallback(nullptr);
    world.deformable().setInternalTickCallback(nullptr);
  }
}

TEST(SolverWithOthers, BodiesComeAndGo) {
  TetskinWorld world;
  auto first = added(world, cageAbove(1)), second = added(world, cageAbove(4));
  step(world, 10);
  first.reset();
  step(world, 10);
  auto third = added(world, smallCageAbove(8));
  Cloth cloth(world);
  step(world, 10);
  world.deformable().removeSoftBody(&second->body());
  step(world, 10);
  second.reset();
  step(world, 100);
  EXPECT_GT(lowest(third->body()), -0.01);
}

TEST(SolverWithOthers, ANegativeOrUndefinedStepOfBulletsWorldMovesNothing) {
  TetskinWorld scene;
  const auto body = added(scene, smallCageAbove(50));
  for (int k = 0; k < 10; ++k) scene.deformable().stepSimulation(btScalar(0.01), 0);
  const std::vector<btVector3> before = nodesOf(body->body());
  for (const btScalar dt : {btScalar(-0.01), std::numeric_limits<btScalar>::quiet_NaN()}) {
    scene.deformable().stepSimulation(dt, 0);
    const std::vector<btVector3> after = nodesOf(body->body());
    for (std::size_t n = 0; n < before.size(); ++n) EXPECT_EQ(after[n], before[n]) << dt;
  }
  scene.deformable().stepSimulation(btScalar(0.01), 0);
  EXPECT_LT(nodesOf(body->body())[0].y(), before[0].y());
}

/// Bullet's deformable world calls it after the prediction, before the solve.
void stepOnce(btDynamicsWorld* world, btScalar) {
  world->setInternalTickCallback(nullptr);
  world->stepSimulation(btScalar(0.01), 0);
}

template <class World>
void expectToFall(World& world, const btSoftBody& body) {
  world.setInternalTickCallback(stepOnce);
  for (int k = 0; k < 100; ++k) world.stepSimulation(btScalar(0.01), 0);
  // 101 steps of free fall, of which one, interrupted, has no gravity of its own.
  EXPECT_NEAR(fastestOf(body), 10, 0.2);
  const std::vector<btVector3> nodes = nodesOf(body);
  EXPECT_LT((nodes[0] - nodes[1]).length(), 2);
}

TEST(SolverWithOthers, ACallbackMayMakeAStepWithinAStep) {
  TetskinWorld bullets;
  const auto inBullets = added(bullets, smallCageAbove(50));
  expectToFall(bullets.deformable(), inBullets->body());
  tetskin::DeformableWorld own;
  own.setGravity(btVector3(0, -10, 0));
  const auto inOwn = DeformableBody::add(own, smallCageAbove(50)).value();
  expectToFall(own, inOwn->body());
}

}  // namespace
}  // namespace tetskin::test
