// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/snapshot.h>

#include "support/replays.h"
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// A body that hangs on a spring with a moving target; a box is welded to it, and a load pulls it now and then.
class Hanging : public ReplayedScene {
 public:
  explicit Hanging(bool welded) {
    const SurfacePoint top = body_.vertex(body_.furthest(Vector3d::UnitY()));
    target_ = *top.position();
    spring_ = SurfaceSpring::add(world(), top).value();
    if (welded) weld_ = SurfaceWeld::add(world(), low_, *box_).value();
  }
  btDeformableMultiBodyDynamicsWorld& world() override { return world_->deformable(); }
  void releaseSpring() { spring_->release(); }
  btVector3 pull() const { return spring_->force(); }
  void frame(int number) override {
    const auto time = btScalar(0.2) * static_cast<btScalar>(number);
    EXPECT_EQ(spring_->setTarget(target_ + btScalar(0.1) * btVector3(std::sin(time), 0, std::cos(time))),
              StatusCode::Ok);
    if (number == 10) {
      EXPECT_EQ(spring_->setStiffness(30), StatusCode::Ok);
    }
    if (!weld_ && number % 5 == 0) {
      EXPECT_EQ(low_.applyForce(btVector3(3, 0, 0), 16), StatusCode::Ok);
    }
    step(*world_, 1);
  }

 private:
  std::unique_ptr<TetskinWorld> world_ = deformableWorld(10);
  TouchedBody body_{*world_, TouchModel(0.38, 3.0)};
  SurfacePoint low_ = body_.vertex(body_.furthest(-Vector3d::UnitY()));
  RigidBox box_{*world_, 0.2, *low_.position() - btVector3(0, btScalar(0.2), 0)};
  std::unique_ptr<SurfaceSpring> spring_;
  std::unique_ptr<SurfaceWeld> weld_;
  btVector3 target_{0, 0, 0};
};

TEST(SnapshotsWithJoints, OfASpringAndAWeldOrALoadThatActsOn) {
  expectReplays([] { return std::make_unique<Hanging>(true); }, 40, {0, 9, 10, 25});
  expectReplays([] { return std::make_unique<Hanging>(false); }, 20, {10});
}

TEST(SnapshotsWithJoints, TellTheForcesOfTheirStep) {
  Hanging scene(true);
  for (int f = 0; f < 5; ++f) scene.frame(f);
  const Bytes snapshot = saved(scene);
  const btVector3 before = scene.pull();
  for (int f = 5; f < 10; ++f) scene.frame(f);
  ASSERT_NE(scene.pull(), before);
  restore(scene, snapshot);
  EXPECT_EQ(scene.pull(), before);
}

TEST(SnapshotsWithJoints, ThatAreGoneAreRefusedAndChangeNothing) {
  Hanging scene(true);
  for (int f = 0; f < 5; ++f) scene.frame(f);
  const Bytes withSpring = saved(scene);
  scene.releaseSpring();
  scene.world().stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  expectRefused(scene.world(), withSpring, StatusCode::SnapshotMismatch, "other springs or welds");
}

/// Two bodies; something acts on one of them.
struct Two {
  Two() = default;
  Bytes snapshot() { return saved(world->deformable()); }
  Status restore(const Bytes& from) { return restored(world->deformable(), from); }
  Status restoreInto(Two& other) { return other.restore(snapshot()); }
  std::unique_ptr<TetskinWorld> world = deformableWorld(10);
  TouchedBody bodies[2] = {TouchedBody(*world, TouchModel(0.38, 3.0)), TouchedBody(*world, TouchModel(0.38, 6.0))};
  SurfacePoint points[2] = {bodies[0].vertex(7), bodies[1].vertex(7)};
};

/// Both worlds behave the same in the next frames.
void expectSameMotion(Two& first, Two& second) {
  for (int f = 0; f < 10; ++f) {
    for (Two* two : {&first, &second}) step(*two->world, 1);
    for (int b = 0; b < 2; ++b) {
      const auto &nodes = first.bodies[b].body().m_nodes, &others = second.bodies[b].body().m_nodes;
      for (int n = 0; n < nodes.size(); ++n) ASSERT_TRUE(nodes[n].m_x == others[n].m_x) << f << " " << b << " " << n;
    }
  }
}

TEST(SnapshotsWithJoints, BringLoadsBackThatHaveEndedAndEndThoseThatHaveBegun) {
  Two loaded, none, others;
  EXPECT_EQ(loaded.points[0].applyForce(btVector3(3, 0, 0), 30), StatusCode::Ok);
  EXPECT_EQ(others.points[1].applyForce(btVector3(0, 5, 0), 7), StatusCode::Ok);
  EXPECT_EQ(others.points[0].applyForce(btVector3(1, 0, 0), 5), StatusCode::Ok);
  const Bytes before = none.snapshot();
  EXPECT_TRUE(loaded.restoreInto(none).ok());
  expectSameMotion(loaded, none);
  ASSERT_TRUE(others.restore(before).ok());
  ASSERT_TRUE(loaded.restore(before).ok());
  expectSameMotion(loaded, others);
}

TEST(SnapshotsWithJoints, OfASpringOfAnotherBodyAreRefused) {
  Two first, other;
  const auto spring = SurfaceSpring::add(first.world->deformable(), first.points[0]).value();
  const auto otherSpring = SurfaceSpring::add(other.world->deformable(), other.points[1]).value();
  EXPECT_EQ(first.restoreInto(other).code, StatusCode::SnapshotMismatch);
}

}  // namespace
}  // namespace tetskin::test
