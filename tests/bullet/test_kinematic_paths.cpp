// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/search/kinematic_paths.h>

#include "deformable_test.h"

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr btScalar kPathStep = btScalar(1) / 240;

/// A box that the application moves, at first at some place.
class KinematicPath : public testing::Test {
 protected:
  KinematicPath() {
    body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    world.deformable().addRigidBody(&body);
    place(start);
  }
  ~KinematicPath() override { world.deformable().removeRigidBody(&body); }

  void place(const btTransform& at) {
    body.setWorldTransform(at);
    body.setInterpolationWorldTransform(at);
  }
  /// Moves and turns the box by a frame, and gives it the velocity that Bullet computes.
  void move(const btVector3& way, btScalar angle, btScalar steps) {
    const btTransform& from = body.getWorldTransform();
    place(btTransform(btQuaternion(axis, angle) * from.getRotation(), from.getOrigin() + way));
    body.setLinearVelocity(way / (steps * kPathStep));
    body.setAngularVelocity(axis * (angle / (steps * kPathStep)));
  }
  void expectAt(const btTransform& found, const btVector3& way, btScalar angle) const {
    EXPECT_LT((found.getOrigin() - start.getOrigin() - way).length(), 1e-5);
    const btMatrix3x3 wanted(btQuaternion(axis, angle) * start.getRotation());
    for (int k = 0; k < 3; ++k) EXPECT_LT((found.getBasis()[k] - wanted[k]).length(), 1e-5);
  }

  const btTransform start{btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)), btVector3(1, 2, 3)};
  const btVector3 axis = btVector3(2, -1, 1).normalized();
  TetskinWorld world;
  btBoxShape shape{btVector3(1, 1, 1)};
  btRigidBody body{0, nullptr, &shape};
  KinematicPaths paths;
};

TEST_F(KinematicPath, IsEvenThroughAllStepsOfAFrame) {
  const std::pair<btVector3, btScalar> motions[] = {{btVector3(btScalar(0.1), 0, btScalar(0.2)), btScalar(0)},
                                                    {btVector3(0, 0, 0), btScalar(0.3)},
                                                    {btVector3(0, btScalar(-0.1), 0), btScalar(0.02)}};
  for (const auto& [way, angle] : motions) {
    for (const int steps : {1, 2, 5}) {
      SCOPED_TRACE(steps);
      place(start);
      paths = {};
      EXPECT_FALSE(paths.advance(body, kPathStep).isKnown);
      for (int step = 0; step < 3 * steps; ++step) {
        if (step % steps == 0) move(way, angle, static_cast<btScalar>(steps));
        const auto& path = paths.advance(body, kPathStep);
        const auto frames = [steps = steps](int count) {
          return static_cast<btScalar>(count) / static_cast<btScalar>(steps);
        };
        EXPECT_TRUE(path.isKnown);
        EXPECT_EQ(path.steps, steps);
        expectAt(path.before, frames(step) * way, frames(step) * angle);
        expectAt(path.now(), frames(step + 1) * way, frames(step + 1) * angle);
      }
      const auto& standing = paths.advance(body, kPathStep);
      expectAt(standing.before, 3 * way, 3 * angle);
      expectAt(standing.now(), 3 * way, 3 * angle);
    }
  }
}

TEST_F(KinematicPath, TakesOneStepWhereTheVelocityDoesNotTellTheNumber) {
  const btVector3 way(btScalar(0.3), 0, 0);
  for (const btScalar steps : {btScalar(2.5), btScalar(0.3), btScalar(1000), btScalar(-2)}) {
    place(start);
    paths = {};
    paths.advance(body, kPathStep);
    move(way, 0, steps);
    EXPECT_EQ(paths.advance(body, kPathStep).steps, 1) << steps;
    expectAt(paths.find(body)->now(), way, 0);
  }
}

TEST_F(KinematicPath, OfASmallTurnTakesAsManyStepsAsTheFrameBefore) {
  const btScalar small = btScalar(0.001);
  paths.advance(body, kPathStep);
  for (int step = 0; step < 16; ++step) {
    if (step % 4 == 0) move(btVector3(0, 0, 0), step < 8 ? btScalar(0.2) : small, 4);
    const btScalar turned = paths.advance(body, kPathStep).steps == 4 ? btScalar(step % 4 + 1) / 4 : 1;
    const btScalar before =
        btScalar(0.2) * btScalar(std::min(step / 4, 2)) + small * btScalar(std::max(step / 4 - 2, 0));
    expectAt(paths.find(body)->now(), btVector3(0, 0, 0), before + turned * (step < 8 ? btScalar(0.2) : small));
    EXPECT_EQ(paths.find(body)->steps, 4) << step;
  }
}

TEST_F(KinematicPath, IsShownOnlyWithinTheStep) {
  const std::vector<btDiscreteDynamicsWorld*> worlds{&world.deformable()};
  const btVector3 way(btScalar(0.4), 0, 0);
  paths.beginStep(worlds, kPathStep);
  paths.endStep();
  move(way, 0, 4);
  for (int step = 1; step <= 4; ++step) {
    paths.beginStep(worlds, kPathStep);
    expectAt(body.getWorldTransform(), btScalar(step) / 4 * way, 0);
    expectAt(body.getInterpolationWorldTransform(), btScalar(step) / 4 * way, 0);
    paths.endStep();
    expectAt(body.getWorldTransform(), way, 0);
    expectAt(body.getInterpolationWorldTransform(), way, 0);
  }
  body.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  paths.beginStep(worlds, kPathStep);
  EXPECT_EQ(paths.find(body), nullptr);
}

TEST_F(KinematicPath, ABodyThatIsMovedWithinTheStepStaysThere) {
  const std::vector<btDiscreteDynamicsWorld*> worlds{&world.deformable()};
  paths.beginStep(worlds, kPathStep);
  move(btVector3(1, 0, 0), 0, 4);
  paths.beginStep(worlds, kPathStep);
  place(btTransform(start.getRotation(), start.getOrigin() + btVector3(0, 5, 0)));
  paths.endStep();
  expectAt(body.getWorldTransform(), btVector3(0, 5, 0), 0);
}

}  // namespace
}  // namespace tetskin::test
