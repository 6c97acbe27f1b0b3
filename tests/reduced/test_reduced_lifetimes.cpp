// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "reduced_test.h"

#include <tetskin/bullet/soft_body_skin.h>

namespace tetskin {
namespace {

using namespace test;

TEST(ReducedBodies, LandAndSleepWhereTheyLie) {
  World world;
  world.addFloor();
  const auto body = added(world, barModes(), fewModes(at(0, 0.5, 0)));
  SoftBodySkin skin;
  const TetMesh bar = fineBar();
  ASSERT_TRUE(skin.bind(body->body(), barCage(), viewOf(bar.nodes)).ok());
  int substeps = 0;
  for (; body->body().isActive() && substeps < 4800; ++substeps) world.step(1);
  ASSERT_FALSE(body->body().isActive());
  EXPECT_GT(lowest(body->body()), -0.02);
  EXPECT_LT(lowest(body->body()), 0.1);
  world.step(1);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  std::vector<Eigen::Vector3d> nodes;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) nodes.push_back(nodeOf(body->body(), n));
  world.step(480);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    EXPECT_EQ(nodeOf(body->body(), n), nodes[static_cast<std::size_t>(n)]) << "to the bit";
  }
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  body->body().activate();
  world.step(10);
  EXPECT_GT(lowest(body->body()), -0.02);
}

TEST(ReducedBodies, OfDifferentSizesLandBesideEachOther) {
  World world;
  world.addFloor();
  // The small body comes first, so that the node indices of the second body do not start at 0.
  TetMesh small = makeBox({3, 2, 2}, Eigen::Vector3d(0.6, 0.4, 0.4));
  VibrationOptions few;
  few.modeCount = 4;
  ReducedBodyOptions options = barOptions(at(-3, 0.5, 0));
  options.skipFastModes = true;
  const VibrationModes smallModes = computeVibrationModes(small, few).value();
  const auto first = ReducedBody::add(*world.world, smallModes, small, options);
  ASSERT_TRUE(first.ok()) << first.status().message;
  const auto second = added(world, barModes(), fewModes(at(0, 0.5, 0)));
  const auto third = added(world, barModes(), fewModes(at(3, 0.8, 0)));
  world.step(480);
  for (const btSoftBody* body : {static_cast<btSoftBody*>(&first.value()->body()),
                                 static_cast<btSoftBody*>(&second->body()), static_cast<btSoftBody*>(&third->body())}) {
    EXPECT_TRUE(allFinite(*body));
    EXPECT_GT(lowest(*body), -0.03);
    EXPECT_LT(lowest(*body), 0.3);
  }
}

TEST(ReducedBodies, LeaveTheWorldWhenTheyGo) {
  World world;
  auto first = added(world, barModes()), second = added(world, barModes(), barOptions(at(0, 3, 0)));
  world.step(5);
  first.reset();
  EXPECT_EQ(world.world->getSoftBodyArray().size(), 1);
  world.step(5);
  EXPECT_TRUE(allFinite(second->body()));
  second.reset();
  EXPECT_EQ(world.world->getSoftBodyArray().size(), 0);
  world.step(5);
}

TEST(ReducedBodies, MayBeTakenOutByTheApplication) {
  World world;
  auto body = added(world, barModes());
  world.step(5);
  world.world->removeSoftBody(&body->body());
  world.step(5);
  body.reset();
  world.step(5);
}

TEST(ReducedBodies, MayOutliveTheirWorld) {
  auto world = std::make_unique<World>();
  auto body = added(*world, barModes());
  world->step(5);
  world->world.reset();
  body.reset();
}

TEST(ReducedBodies, AreMetByRays) {
  World world;
  const auto body = added(world, barModes());
  world.step(1);
  const btVector3 from(0, 5, 0), to(0, -5, 0);
  btCollisionWorld::ClosestRayResultCallback hit(from, to);
  world.world->rayTest(from, to, hit);
  EXPECT_EQ(hit.m_collisionObject, &body->body());
}

TEST(ReducedLifetimes, LeavesABodyToTheWorldThatItWasMovedTo) {
  auto first = std::make_unique<World>();
  World second;
  auto body = added(*first, barModes());
  btReducedDeformableBody* moved = &body->body();
  first->world->removeSoftBody(moved);
  second.world->addSoftBody(moved);
  first.reset();
  body.reset();
  EXPECT_EQ(second.world->getSoftBodyArray().size(), 1);
  second.world->removeSoftBody(moved);
  delete moved;
}

TEST(ReducedLifetimes, RefusesAWorldThatDoesNotAskSleepersForTheirBoxes) {
  World world;
  world.world->setForceUpdateAllAabbs(false);
  EXPECT_EQ(ReducedBody::add(*world.world, barModes(), barCage(), barOptions()).status().code,
            StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin
