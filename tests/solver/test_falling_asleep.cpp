// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// When bodies fall asleep: soon after they lie, whatever their numbers; and never where they would go on.
#include "deformable_test.h"
#include "support/rigids.h"

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <limits>
#include <memory>
#include <utility>

namespace tetskin::test {
namespace {

constexpr double kShown = 1.0 / 60.0, kPull = 9.81, kHalfTurn = EIGEN_PI;

struct Given {
  double stiffness = 300;  ///< over density, gravity and size
  double damping = 0.02;
  int substeps = 4;
  double size = 1.0, tilt = 0.0, friction = 0.5, sleepAfter = 0.5;
};

std::ostream& operator<<(std::ostream& to, const Given& n) {
  return to << "stiffness " << n.stiffness << ", damping " << n.damping << ", " << n.substeps << " substeps, size "
            << n.size << ", tilt " << n.tilt;
}

DeformableWorldOptions worldOf(const Given& numbers) {
  DeformableWorldOptions options;
  options.gravity = {static_cast<btScalar>(kPull * std::sin(numbers.tilt)),
                     static_cast<btScalar>(-kPull * std::cos(numbers.tilt)), 0};
  options.sleepAfter = static_cast<btScalar>(numbers.sleepAfter);
  return options;
}

struct OwnsWorld {
  explicit OwnsWorld(const Given& numbers) : world(worldOf(numbers)) {}
  tetskin::DeformableWorld world;
};

/// A cube that falls by a tenth of its size onto a box.
class Lying : public OwnsWorld, public Rigids {
 public:
  explicit Lying(const Given& n = {}, double fall = 0.1) : OwnsWorld(n), Rigids(world), numbers(n) {
    const auto size = static_cast<btScalar>(n.size);
    ground = &add(shape<btBoxShape>(btVector3(20 * size, size, 20 * size)), 0, btVector3(0, -size, 0));
    ground->setFriction(1);
    TetMesh cage = lifted(latticeCage(3, 3, 3, n.size / 3), fall * n.size);
    for (Eigen::Vector3d& node : cage.nodes) node -= Eigen::Vector3d(n.size / 2, 0, n.size / 2);
    SoftBodyOptions options;
    options.density = 100;
    options.youngsModulus = n.stiffness * 100 * kPull * n.size;
    options.stiffnessDamping = n.damping;
    options.friction = n.friction;
    made = DeformableBody::add(world, cage, options).value();
  }
  btSoftBody& body() { return made->body(); }
  void frame() {
    world.stepSimulation(static_cast<btScalar>(kShown), numbers.substeps,
                         static_cast<btScalar>(kShown / numbers.substeps));
  }
  /// Seconds until the body sleeps, in frames; or `most`.
  double sleepsAfter(
      double most, const std::function<void()>& before = [] {}) {
    for (int f = 0; f * kShown < most; ++f) {
      if (!body().isActive()) return f * kShown;
      before();
      last = nodesOf(body());
      frame();
    }
    return most;
  }
  /// The longest way of a node, in body sizes.
  double way(const std::vector<btVector3>& from) {
    btScalar squared = 0;
    for (std::size_t n = 0; n < from.size(); ++n)
      squared = std::max(squared, (body().m_nodes[static_cast<int>(n)].m_x - from[n]).length2());
    return std::sqrt(static_cast<double>(squared)) / numbers.size;
  }

  Given numbers;
  btRigidBody* ground = nullptr;
  std::unique_ptr<DeformableBody> made;
  std::vector<btVector3> last;  ///< the nodes before the frame in which it fell asleep
};

/// It sleeps where it would have stayed; its forces are what it weighs; nothing jumps, neither then nor when it wakes.
TEST(FallingAsleep, IsSoonWhateverTheNumbers) {
  for (const double stiffness : {100.0, 3000.0, 1e5}) {
    for (const double damping : {0.005, 0.02, 0.1}) {
      for (const int substeps : {1, 4}) {
        for (const double size : {0.05, 1.0, 5.0}) {
          Lying scene({stiffness, damping, substeps, size});
          const auto forces = ForceRecord::add(scene.world).value();
          // Time scales with that in which gravity moves it by its size; soft ones of little damping swing for longer.
          const double swings = 4 * std::sqrt(size / kPull) + (stiffness < 1000 ? 5.0 * size : 1.0);
          const double after = scene.sleepsAfter(10);
          EXPECT_LT(after, 0.5 + swings) << scene.numbers;
          EXPECT_GT(after, 0.5) << scene.numbers;
          EXPECT_LT(scene.way(scene.last), 1e-3) << scene.numbers;
          const double weight = kPull * 100 * size * size * size;
          const auto up = static_cast<double>(forces->forcesOn(scene.body()).total().force.y());
          EXPECT_NEAR(up / weight, 1.0, 0.005) << scene.numbers;
          const std::vector<btVector3> asleep = nodesOf(scene.body());
          scene.body().activate();
          scene.frame();
          EXPECT_LT(scene.way(asleep), 1e-3) << scene.numbers << ": wakes";
          scene.body().setActivationState(DISABLE_DEACTIVATION);
          for (int f = 0; f < 120; ++f) scene.frame();
          EXPECT_LT(scene.way(asleep), 5e-3) << scene.numbers << ": would have moved on";
        }
      }
    }
  }
}

TEST(FallingAsleep, TakesAsLongAsTheWorldSays) {
  for (const double seconds : {0.1, 1.0, 2.5}) {
    Given numbers;
    numbers.sleepAfter = seconds;
    const double after = Lying(numbers, 0.0).sleepsAfter(6);
    EXPECT_GE(after, seconds - kShown);
    EXPECT_LT(after, seconds + 0.6);
  }
  Given never;
  never.sleepAfter = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Lying(never, 0.0).sleepsAfter(6), 6.0);
}

TEST(FallingAsleep, RefusesATimeBelowZeroAndNone) {
  DeformableSolver solver;
  ASSERT_TRUE(solver.setSleepAfter(btScalar(1.5)).ok());
  for (const btScalar wrong : {btScalar(-1), std::numeric_limits<btScalar>::quiet_NaN()}) {
    const Status status = solver.setSleepAfter(wrong);
    EXPECT_EQ(status.code, StatusCode::InvalidOption);
    EXPECT_NE(status.message.find("at least 0"), std::string::npos) << status.message;
    EXPECT_EQ(solver.sleepAfter(), btScalar(1.5));
  }
}

/// Friction is 0.5: the angle is 26.565 degrees.
TEST(FallingAsleep, IsNotOnASlopeThatItSlidesDown) {
  for (const double stiffness : {100.0, 1e4}) {
    for (const double degrees : {26.7, 27.0, 30.0}) {
      for (const double size : {0.1, 1.0}) {
        for (const double up : {0.0, 0.3}) {
          Lying scene({stiffness, 0.02, 4, size, degrees * kHalfTurn / 180}, 0.005);
          scene.body().setVelocity(btVector3(static_cast<btScalar>(-up * std::sqrt(size)), 0, 0));
          EXPECT_EQ(scene.sleepsAfter(3), 3.0) << scene.numbers << ", pushed up at " << up;
        }
      }
    }
  }
  EXPECT_LT(Lying({1e4, 0.02, 4, 1.0, 20 * kHalfTurn / 180}, 0.005).sleepsAfter(3), 2.0) << "it holds there";
}

TEST(FallingAsleep, IsNotOnASmoothSlopeOfATenthOfADegree) {
  EXPECT_EQ(Lying({3000, 0.02, 4, 1.0, 0.1 * kHalfTurn / 180, 0.0}, 0.005).sleepsAfter(3), 3.0);
}

TEST(FallingAsleep, IsNotAtTheTopOfAThrow) {
  for (const double speed : {0.02, 0.1, 2.0}) {
    Lying scene({}, 0.5);
    scene.body().setVelocity(btVector3(0, static_cast<btScalar>(speed), 0));
    bool slept = false;
    for (int f = 0; f * kShown < speed / kPull + 0.25; ++f) {
      scene.frame();
      slept |= !scene.body().isActive();
    }
    EXPECT_FALSE(slept) << speed;
  }
}

/// The ground is moved once per frame.
TEST(FallingAsleep, IsNotOnASlowLiftBeltOrTurntable) {
  const auto move = [](Lying& scene, const btVector3& velocity, double rate) {
    scene.ground->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    scene.ground->setActivationState(DISABLE_DEACTIVATION);
    auto seconds = btScalar(0);
    return scene.sleepsAfter(4, [&, seconds]() mutable {
      seconds += static_cast<btScalar>(kShown);
      const btQuaternion turned(btVector3(0, 1, 0), static_cast<btScalar>(rate) * seconds);
      scene.ground->setWorldTransform(btTransform(turned, btVector3(0, -1, 0) + seconds * velocity));
    });
  };
  for (const double speed : {1e-4, 1e-3, 0.01}) {
    const auto v = static_cast<btScalar>(speed);
    Lying lifted({}, 0.01), carried({}, 0.01), turned({}, 0.01);
    EXPECT_EQ(move(lifted, btVector3(0, v, 0), 0), 4.0) << speed;
    EXPECT_EQ(move(carried, btVector3(v, 0, 0), 0), 4.0) << speed;
    EXPECT_EQ(move(turned, btVector3(0, 0, 0), speed), 4.0) << speed;
  }
}

/// Rigid bodies follow the same rule where they lie on a soft one.
TEST(FallingAsleep, OfARigidBodyOnASoftOneIsAsSoonAndNotWhileItGlides) {
  const btScalar half = btScalar(0.4);
  for (const double speed : {0.0, 0.002, 0.004, 0.1}) {
    Given given;
    given.stiffness = 1e5;
    given.friction = speed > 0.0 ? 0.0 : 0.5;
    Lying scene(given, 0.0);
    btRigidBody& box = scene.add(scene.shape<btBoxShape>(btVector3(half, half, half)), 5, btVector3(0, 1 + half, 0));
    for (int f = 0; f < 20; ++f) scene.frame();
    box.setLinearVelocity(btVector3(static_cast<btScalar>(speed), 0, 0));
    const double after = scene.sleepsAfter(1.8);
    EXPECT_EQ(after < 1.8, speed == 0.0) << speed << " after " << after;
    EXPECT_EQ(box.isActive(), speed > 0.0) << speed;
  }
}

TEST(FallingAsleep, OfRigidBodiesAmongThemselvesIsBullets) {
  Lying scene;
  const btScalar half = btScalar(0.15);
  btRigidBody& alone = scene.add(scene.shape<btBoxShape>(btVector3(half, half, half)), 1, btVector3(8, half, 0));
  int frames = 0;
  for (; alone.isActive() && frames < 300; ++frames) scene.frame();
  EXPECT_FALSE(scene.body().isActive());
  EXPECT_GE(frames * kShown, 1.99);
  EXPECT_LT(frames * kShown, 2.2);
}

}  // namespace
}  // namespace tetskin::test
