// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/search/kinematic_paths.h>

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

/// The share of its first frame's way that a body which stood has made.
btScalar firstWay(btScalar fraction) {
  return fraction - fraction * (1 - fraction) * (1 - fraction);
}

TEST_F(KinematicPath, BeginsAtRestAndIsEvenThroughAllStepsOfLaterFrames) {
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
          const btScalar made = static_cast<btScalar>(count) / static_cast<btScalar>(steps);
          return made < 1 ? firstWay(made) : made;
        };
        EXPECT_TRUE(path.isKnown);
        EXPECT_EQ(path.steps, steps);
        expectAt(path.before, frames(step) * way, frames(step) * angle);
        expectAt(path.now(), frames(step + 1) * way, frames(step + 1) * angle);
      }
      for (int step = 0; step < 2 * steps; ++step) {
        const auto& standing = paths.advance(body, kPathStep);
        expectAt(standing.before, 3 * way, 3 * angle);
        expectAt(standing.now(), 3 * way, 3 * angle);
      }
      move(way, angle, static_cast<btScalar>(steps));
      for (int step = 1; step <= steps; ++step) {  // it begins at rest again
        const btScalar made = 3 + firstWay(static_cast<btScalar>(step) / static_cast<btScalar>(steps));
        expectAt(paths.advance(body, kPathStep).now(), made * way, made * angle);
      }
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
    EXPECT_EQ(paths.advance(body, kPathStep).steps, 4) << step;
    if (step % 4 < 3) continue;
    const int frames = step / 4 + 1;
    expectAt(paths.find(body)->now(), btVector3(0, 0, 0),
             btScalar(0.2) * btScalar(std::min(frames, 2)) + small * btScalar(std::max(frames - 2, 0)));
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
    expectAt(body.getWorldTransform(), firstWay(btScalar(step) / 4) * way, 0);
    expectAt(body.getInterpolationWorldTransform(), firstWay(btScalar(step) / 4) * way, 0);
    expectAt(paths.startOf(body), firstWay(btScalar(step - 1) / 4) * way, 0);
    EXPECT_TRUE(paths.knowsStart(body));
    paths.endStep();
    expectAt(body.getWorldTransform(), way, 0);
    expectAt(body.getInterpolationWorldTransform(), way, 0);
  }
  body.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  paths.beginStep(worlds, kPathStep);
  EXPECT_EQ(paths.find(body), nullptr);
}

TEST_F(KinematicPath, OfABodyThatTurnsAroundAnAxleIsNearACircle) {
  const btScalar turn = btScalar(0.4), radius = 2;
  const auto at = [&](btScalar angle) {
    const btQuaternion rotation(axis, angle);
    const btVector3 arm = radius * axis.cross(btVector3(0, 0, 1)).normalized();
    return btTransform(rotation * start.getRotation(), start.getOrigin() + quatRotate(rotation, arm) - arm);
  };
  paths.advance(body, kPathStep);
  for (int step = 0; step < 40; ++step) {
    const auto frames = static_cast<btScalar>(step / 4);
    if (step % 4 == 0) {
      const btTransform from = body.getWorldTransform(), to = at((frames + 1) * turn);
      place(to);
      body.setLinearVelocity((to.getOrigin() - from.getOrigin()) / (4 * kPathStep));
      body.setAngularVelocity(axis * (turn / (4 * kPathStep)));
    }
    const btTransform now = paths.advance(body, kPathStep).now();
    if (step < 12) continue;
    const btTransform wanted = at((frames + static_cast<btScalar>(step % 4 + 1) / 4) * turn);
    // On straight paths, it would be off by 0.04.
    EXPECT_LT((now.getOrigin() - wanted.getOrigin()).length(), 0.004) << step;
    for (int k = 0; k < 3; ++k) EXPECT_LT((now.getBasis()[k] - wanted.getBasis()[k]).length(), 1e-4) << step;
  }
}

TEST_F(KinematicPath, OfABodyThatIsPutElsewhereBeginsThere) {
  paths.advance(body, kPathStep);
  for (int frame = 0; frame < 3; ++frame) {
    move(btVector3(1, 0, 0), 0, 1);
    paths.advance(body, kPathStep);
    EXPECT_TRUE(paths.knowsStart(body));
  }
  place(btTransform(start.getRotation(), start.getOrigin() + btVector3(0, 50, 0)));
  body.setLinearVelocity(btVector3(0, 0, 0));
  paths.advance(body, kPathStep);
  EXPECT_FALSE(paths.knowsStart(body));
  expectAt(paths.startOf(body), btVector3(0, 50, 0), 0);
  paths.advance(body, kPathStep);
  EXPECT_TRUE(paths.knowsStart(body));
  expectAt(paths.find(body)->now(), btVector3(0, 50, 0), 0);
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
