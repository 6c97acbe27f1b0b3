// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// With threads, searches for contacts with rigid objects wait until all pairs of a step are known.
#include "contact_test.h"
#include "support/shuffled_threads.h"

#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <tetskin/threads/thread_pool.h>

namespace tetskin::test {
namespace {

/// Three balls that fall on a floor and on a rigid box that sleeps on it.
struct BallsAndABox {
  explicit BallsAndABox(ParallelFor* threads)
      : floor(world, std::make_unique<btBoxShape>(btVector3(9, 1, 9)), placeAt(btVector3(0, -1, 0))),
        box(world, std::make_unique<btBoxShape>(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3))),
            placeAt(btVector3(0, btScalar(0.1), 0)), 1) {
    world.bodySolver().setThreads(threads);
    box.body().forceActivationState(ISLAND_SLEEPING);
    for (int k = 0; k < 3; ++k) {
      balls.push_back(std::make_unique<TouchingBody>(world, ballMesh(16, 0.35), btVector3(btScalar(1.5) * k, 1, 0)));
    }
  }

  TetskinWorld world;
  Obstacle floor, box;
  std::vector<std::unique_ptr<TouchingBody>> balls;
};

TEST(WaitingSearch, GivesTheSameBitsAsASearchAtOnce) {
  ShuffledThreads threads(3);
  BallsAndABox alone(nullptr), together(&threads);
  std::size_t contacts = 0;
  for (int s = 0; s < 120; ++s) {
    step(alone.world, 1);
    step(together.world, 1);
    for (std::size_t k = 0; k < alone.balls.size(); ++k) {
      const auto& wanted = alone.balls[k]->contact->contacts();
      ASSERT_EQ(together.balls[k]->contact->contacts().size(), wanted.size()) << s;
      contacts += wanted.size();
      const btSoftBody &a = alone.balls[k]->body->body(), &b = together.balls[k]->body->body();
      for (int n = 0; n < a.m_nodes.size(); ++n) ASSERT_EQ(a.m_nodes[n].m_x, b.m_nodes[n].m_x) << s;
    }
  }
  EXPECT_GT(contacts, 100U);
}

TEST(WaitingSearch, WakesWhatSleepsInTheSameStep) {
  ShuffledThreads threads(3);
  BallsAndABox alone(nullptr), together(&threads);
  for (int s = 0; s < 120 && !alone.box.body().isActive(); ++s) {
    step(alone.world, 1);
    step(together.world, 1);
    ASSERT_EQ(together.box.body().isActive(), alone.box.body().isActive()) << s;
  }
  EXPECT_TRUE(together.box.body().isActive());
}

TEST(WaitingSearch, ForgetsAnObjectThatIsRemovedBetweenSteps) {
  ShuffledThreads threads(3);
  BallsAndABox balls(&threads);
  step(balls.world, 40);
  {
    const Obstacle other(balls.world, std::make_unique<btSphereShape>(btScalar(0.2)),
                         placeAt(btVector3(3, btScalar(0.2), 0)));
    step(balls.world, 60);
  }
  step(balls.world, 20);
  EXPECT_LT(balls.balls[2]->height(), 0.1);
}

/// Bullet's own shape counts its queries and sets pointers in them, without a lock. How often two threads disturb each
/// other depends on the machine: a sanitizer of threads sees it in any case.
TEST(WaitingSearch, MayMeetOneGImpactShapeOnSeveralThreads) {
  btTriangleMesh hills;
  const auto at = [](int x, int z) {
    return btVector3(btScalar(0.1) * x, btScalar(0.02) * ((3 * x + 5 * z) % 4), btScalar(0.1) * z);
  };
  for (int x = -8; x < 60; ++x) {
    for (int z = -8; z < 8; ++z) {
      hills.addTriangle(at(x, z), at(x, z + 1), at(x + 1, z));
      hills.addTriangle(at(x + 1, z), at(x, z + 1), at(x + 1, z + 1));
    }
  }
  const auto run = [&](ParallelFor* threads) {
    TetskinWorld world;
    world.bodySolver().setThreads(threads);
    auto shape = std::make_unique<btGImpactMeshShape>(&hills);
    shape->updateBound();
    const Obstacle ground(world, std::move(shape), placeAt(btVector3(0, 1, 0)));
    std::vector<std::unique_ptr<TouchingBody>> balls;
    for (int k = 0; k < 8; ++k) {
      balls.push_back(
          std::make_unique<TouchingBody>(world, ballMesh(8, 0.35), btVector3(btScalar(0.7) * k, btScalar(1.45), 0)));
    }
    step(world, 12);
    std::vector<btVector3> nodes;
    for (const auto& ball : balls) {
      EXPECT_FALSE(ball->contact->contacts().empty());
      for (int n = 0; n < ball->body->body().m_nodes.size(); ++n) nodes.push_back(ball->body->body().m_nodes[n].m_x);
    }
    return nodes;
  };
  ThreadPool pool(4);
  EXPECT_EQ(run(&pool), run(nullptr));
}

}  // namespace
}  // namespace tetskin::test
