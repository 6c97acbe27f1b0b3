// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// If memory runs out, or a callback throws: the world stays, and can be restored.
#include <tetskin/replay/snapshot.h>

#include <stdexcept>

#include "solver/deformable_test.h"
#include "solver/rigid_scene.h"
#include "support/allocation_count.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

class SmallWorld {
 public:
  SmallWorld() {
    const btScalar half = btScalar(0.2);
    rigids.add(rigids.shape<btBoxShape>(btVector3(20, 1, 20)), 0, btVector3(0, -1, 0));
    rigids.add(rigids.shape<btBoxShape>(btVector3(half, half, half)), 100, btVector3(btScalar(0.3), btScalar(1.1), 0));
    first = DeformableBody::add(world, smallCageAbove(0.1)).value();
  }
  void step(int count = 1) {
    for (int k = 0; k < count; ++k) world.stepSimulation(btScalar(1) / 120, 2, btScalar(1) / 240);
  }

  tetskin::DeformableWorld world;
  Rigids rigids{world};
  std::unique_ptr<DeformableBody> first, second;
};

TEST(MemoryRunsOut, WhileABodyIsAddedAndTheWorldIsAsItWas) {
  SmallWorld scene;
  scene.step(3);
  const Bytes before = saved(scene.world);
  const auto& forces = *scene.world.deformableSolver().getLagrangianForceArray();
  const int forceCount = forces.size();
  const TetMesh cage = smallCageAbove(2);
  const int failures = failEachAllocation([&] { scene.second = DeformableBody::add(scene.world, cage).value(); },
                                          [&] {
                                            ASSERT_EQ(scene.world.getSoftBodyArray().size(), 1);
                                            ASSERT_EQ(scene.world.getNumCollisionObjects(), 3);
                                            ASSERT_EQ(forces.size(), forceCount);
                                            ASSERT_TRUE(saved(scene.world) == before);
                                          });
  EXPECT_GT(failures, 100);
  scene.step(10);
  EXPECT_EQ(scene.second->solverPath(), SolverPath::Solver);
}

TEST(MemoryRunsOut, WithinAStepAndTheWorldIsRestored) {
  SmallWorld scene;
  scene.step(30);
  const Bytes before = saved(scene.world);
  scene.step(3);
  const Bytes expected = saved(scene.world);
  const auto restore = [&] {
    const Status status = restoreSnapshot(scene.world, before.data(), before.size());
    ASSERT_TRUE(status.ok()) << status.message;
  };
  restore();
  const int failures = failEachAllocation([&] { scene.step(); },
                                          [&] {
                                            restore();
                                            scene.step(3);
                                            ASSERT_TRUE(saved(scene.world) == expected);
                                            restore();
                                          });
  EXPECT_GT(failures, 100);
}

/// A hidden body sleeps for Bullet in the middle of a step: it does not when an exception has left it there.
TEST(ExceptionsWithinSteps, LeaveAWorldThatCanBeRestoredOrStepsOn) {
  SmallWorld scene;
  scene.step(30);
  const Bytes before = saved(scene.world);
  scene.step(3);
  const Bytes expected = saved(scene.world);
  static int calls;
  const auto failing = [] {
    if (++calls == 2) throw std::runtime_error("from a callback");
  };
  const auto inSolver = [](btScalar, btDeformableMultiBodyDynamicsWorld* world) {
    (*static_cast<decltype(failing)*>(world->getWorldUserInfo()))();
  };
  const auto inTick = [](btDynamicsWorld* world, btScalar) {
    (*static_cast<decltype(failing)*>(world->getWorldUserInfo()))();
  };
  for (const int where : {0, 1, 2}) {
    for (const bool restores : {true, false}) {
      ASSERT_TRUE(restoreSnapshot(scene.world, before.data(), before.size()).ok());
      calls = 0;
      scene.world.setWorldUserInfo(const_cast<void*>(static_cast<const void*>(&failing)));
      if (where == 0) scene.world.setSolverCallback(inSolver);
      if (where > 0) scene.world.setInternalTickCallback(inTick, scene.world.getWorldUserInfo(), where == 1);
      EXPECT_THROW(scene.step(), std::runtime_error);
      scene.world.setSolverCallback(nullptr);
      for (const bool first : {true, false}) scene.world.setInternalTickCallback(nullptr, nullptr, first);
      EXPECT_TRUE(scene.first->body().isActive()) << where;
      if (restores) {
        const Status status = restoreSnapshot(scene.world, before.data(), before.size());
        ASSERT_TRUE(status.ok()) << where << ' ' << status.message;
      }
      scene.step(3);
      EXPECT_TRUE(!restores || saved(scene.world) == expected) << where;
      EXPECT_TRUE(std::isfinite(rmsSpeed(scene.first->body())));
    }
  }
}

}  // namespace
}  // namespace tetskin::test
