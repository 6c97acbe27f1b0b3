// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies that are squashed flat by rigid ones of many times their mass, far more than they can carry.
#include "rigid_bodies.h"

namespace tetskin::test {
namespace {

constexpr double kSize = 0.9;
constexpr btScalar kStep = btScalar(1) / 240;

/// A block of 1 kg on the floor, and a rigid box above it.
struct Press {
  explicit Press(double ratio) {
    TetMesh cage = shifted(latticeCage(3, 3, 3, kSize / 3), Eigen::Vector3d(-kSize / 2, 0.03, -kSize / 2));
    block = added(world, cage);
    block->body().m_cfg.kDF = btScalar(0.5);
    const btVector3 half(btScalar(0.8), btScalar(0.5), btScalar(0.8));
    box = std::make_unique<Rigid>(world, std::make_unique<btBoxShape>(half), static_cast<btScalar>(ratio),
                                  btVector3(0, btScalar(0.98 + 0.5), 0));
    box->body->setActivationState(DISABLE_DEACTIVATION);
    record = ForceRecord::add(world.deformable()).value();
  }
  void run(int steps) {
    for (int k = 0; k < steps; ++k) world.deformable().stepSimulation(kStep, 0, kStep);
  }
  double fastest() const { return fastestOf(block->body()); }
  double height() const {
    double highest = 0.0;
    for (int n = 0; n < block->body().m_nodes.size(); ++n) {
      highest = std::max(highest, static_cast<double>(block->body().m_nodes[n].m_x.y()));
    }
    return highest;
  }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> block;
  std::unique_ptr<Rigid> box;
  std::unique_ptr<ForceRecord> record;
};

/// Without the cure nodes keep moving at sixty sizes per second.
TEST(SquashedBodies, ComeToRestAndCarryTheWholeWeight) {
  for (const double ratio : {100.0, 1000.0}) {
    Press press(ratio);
    press.run(720);
    EXPECT_LT(press.height(), 0.3 * kSize) << ratio;
    for (int k = 0; k < 60; ++k) {
      press.run(1);
      EXPECT_LT(press.fastest(), 0.01 * kSize) << ratio;
      const double carried = static_cast<double>(press.record->forcesOn(*press.box->body).total().force.y());
      EXPECT_NEAR(carried / (10.0 * ratio), 1.0, 0.01) << ratio;
    }
  }
}

TEST(SquashedBodies, ComeBackWhenTheLoadIsTakenAway) {
  Press press(100.0);
  press.run(240);
  press.box.reset();
  press.block->body().activate();
  press.run(720);
  EXPECT_NEAR(press.height() - test::lowest(press.block->body()), kSize, 0.1 * kSize);
}

}  // namespace
}  // namespace tetskin::test
