// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Features that need a DeformableSolver, and the messages in a world without one.
#include "deformable_test.h"

namespace tetskin::test {
namespace {

Status statusOf(EmptyWorld& world, const SoftBodyOptions& options) {
  return DeformableBody::add(world.deformable(), smallCageAbove(5), options).status();
}

bool tells(const Status& status, const char* word) {
  return status.message.find(word) != std::string::npos;
}

TEST(RequiredSolver, CorotatedBodiesAreRefusedInAWorldWithAnotherSolver) {
  EmptyWorld bullets, reduced(std::make_unique<btReducedDeformableBodySolver>());
  for (EmptyWorld* world : {&bullets, &reduced}) {
    const Status status = statusOf(*world, {});
    EXPECT_EQ(status.code, StatusCode::InvalidOption);
    EXPECT_TRUE(tells(status, "DeformableSolver")) << status.message;
    EXPECT_FALSE(tells(status, "implicit")) << status.message;
    EXPECT_EQ(world->deformable().getSoftBodyArray().size(), 0);
  }
}

TEST(RequiredSolver, AllThatMustChangeIsTold) {
  EmptyWorld bullets;
  TetskinWorld ours;
  SoftBodyOptions options;
  options.implicit = true;
  const Status both = statusOf(bullets, options), one = statusOf(ours, options);
  EXPECT_EQ(both.code, StatusCode::InvalidOption);
  EXPECT_TRUE(tells(both, "DeformableSolver") && tells(both, "implicit")) << both.message;
  EXPECT_EQ(one.code, StatusCode::InvalidOption);
  EXPECT_TRUE(!tells(one, "DeformableSolver") && tells(one, "implicit")) << one.message;
  EXPECT_EQ(ours.deformable().getSoftBodyArray().size(), 0);
}

TEST(RequiredSolver, ARefusalChangesNothingOfTheWorld) {
  EmptyWorld world;
  world.deformable().setUseProjection(false);
  EXPECT_FALSE(statusOf(world, {}).ok());
  test::step(world, 1);
  EXPECT_FALSE(static_cast<btDeformableBodySolver&>(*world.softSolver).m_useProjection);
}

TEST(RequiredSolver, BulletsForcesNeedNone) {
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::LinearElasticity}) {
    EmptyWorld bullets, reduced(std::make_unique<btReducedDeformableBodySolver>());
    TetskinWorld ours;
    SoftBodyOptions options;
    options.forceModel = model;
    EXPECT_TRUE(statusOf(bullets, options).ok());
    EXPECT_TRUE(statusOf(ours, options).ok());
    const Status status = statusOf(reduced, options);
    EXPECT_EQ(status.code, StatusCode::InvalidOption);
    EXPECT_TRUE(tells(status, "DeformableSolver")) << status.message;
  }
}

}  // namespace
}  // namespace tetskin::test
