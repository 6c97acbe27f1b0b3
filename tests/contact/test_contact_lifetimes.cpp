// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Things go in any order.
#include "contact_test.h"

namespace tetskin::test {
namespace {

std::unique_ptr<TouchingBody> lying(EmptyWorld& world) {
  auto body = std::make_unique<TouchingBody>(world, ballMesh(12, 0.35), btVector3(0, btScalar(0.36), 0));
  step(world, 10);
  EXPECT_FALSE(body->contact->contacts().empty());
  return body;
}

TEST(ContactLifetimes, ContactGoesFirstAndTheCageIsMetAgain) {
  TetskinWorld world;
  const auto body = lying(world);
  body->contact.reset();
  step(world, 120);
  EXPECT_GT(lowest(body->body->body()), -0.02);  // from -0.15
}

TEST(ContactLifetimes, BodyGoesFirst) {
  TetskinWorld world;
  const auto body = lying(world);
  body->body.reset();
  EXPECT_TRUE(body->contact->contacts().empty());
  step(world, 3);
  body->contact.reset();
  step(world, 3);
}

TEST(ContactLifetimes, ABodyAtTheOldAddressIsAnother) {
  TetskinWorld world;
  for (int k = 0; k < 4; ++k) {
    const auto body = lying(world);
    body->body.reset();
    // Without contact of its own it meets the floor by its cage, whatever is left of the other.
    TetMesh cage = looseCage();
    for (Eigen::Vector3d& p : cage.nodes) p.y() += 0.52;
    const auto plain = added(world, cage);
    step(world, 60);
    EXPECT_GT(lowest(plain->body()), 0.0);
  }
}

TEST(ContactLifetimes, WorldGoesFirst) {
  auto world = std::make_unique<TetskinWorld>();
  auto body = lying(*world);
  world.reset();
  body.reset();
}

TEST(ContactLifetimes, ObstaclesComeAndGoInTouch) {
  TetskinWorld world;
  const auto body = std::make_unique<TouchingBody>(world, ballMesh(12, 0.35), btVector3(0, btScalar(2.5), 0));
  for (int k = 0; k < 5; ++k) {
    const Obstacle shelf(world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.1), 1)),
                         placeAt(btVector3(0, btScalar(body->height()) - btScalar(0.11), 0)));
    step(world, 10);
    EXPECT_FALSE(body->contact->contacts().empty()) << k;
  }
  step(world, 60);
  EXPECT_LT(body->height(), 2.0);
}

TEST(ContactLifetimes, NoObstacleIsToldOfThatHasLeftTheWorld) {
  TetskinWorld world;
  const auto shelfAt = [&](btScalar x) {
    return std::make_unique<Obstacle>(world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.5), 1)),
                                      placeAt(btVector3(x, 4, 0)));
  };
  auto left = shelfAt(-1), right = shelfAt(1);
  TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.35, 0.35)), btVector3(0, btScalar(4.86), 0));
  const auto touches = [&](const btCollisionObject* object) {
    const auto all = body.contact->contacts();
    return std::any_of(all.begin(), all.end(), [&](const SurfaceContactPoint& at) { return at.object == object; });
  };
  step(world, 30);
  const btCollisionObject *gone = &left->body(), *stays = &right->body();
  ASSERT_TRUE(touches(gone));
  ASSERT_TRUE(touches(stays));
  left.reset();
  EXPECT_FALSE(touches(gone));
  EXPECT_TRUE(touches(stays));
  step(world, 1);
  EXPECT_FALSE(touches(gone));
}

TEST(ContactLifetimes, OtherSoftBodiesKeepBulletsPath) {
  TetskinWorld world;
  const TouchingBody body(world, ballMesh(12, 0.35), btVector3(0, btScalar(0.36), 0));
  TetMesh cage = looseCage();
  for (Eigen::Vector3d& p : cage.nodes) p += Eigen::Vector3d(3, 0.55, 0);
  const auto plain = added(world, cage);
  step(world, 120);
  EXPECT_NEAR(lowest(plain->body()), 0.02, 0.01);
}

TEST(ContactLifetimes, TheRegistryIsForgottenWithItsDispatcher) {
  for (int k = 0; k < 3; ++k) {
    auto world = std::make_unique<TetskinWorld>();
    const auto body = lying(*world);
    body->contact.reset();
    body->body.reset();
    SurfaceContact::shutdown(world->dispatcher);
    SurfaceContact::shutdown(world->dispatcher);  // once is enough
  }
}

}  // namespace
}  // namespace tetskin::test
