// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies that rest on each other: their contacts are followed while they hardly move, and end when they do.

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

constexpr double kCubeEdge = 0.6;

/// A cube that fills its cage except for a hundredth of its size.
struct SoftCube {
  TetMesh cage = latticeCage(3, 3, 3, kCubeEdge / 3);
  TriangleMesh mesh;
  std::shared_ptr<const ContactShape> shape;

  SoftCube() {
    const double low = 0.005, high = kCubeEdge - 0.005;
    for (int c = 0; c < 8; ++c) mesh.positions.emplace_back(c & 1 ? high : low, c & 2 ? high : low, c & 4 ? high : low);
    mesh.triangles = plate().mesh.triangles;
    shape = ContactShape::create(cage, mesh).value();
  }
};

const SoftCube& softCube() {
  static const SoftCube made;
  return made;
}

/// A cube on another one, whose lower half is pinned; both turned about the z-axis.
struct TwoCubes {
  explicit TwoCubes(double angle = 0.0, double gap = 1e-3) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    const auto cube = [&](double height, bool held) {
      TetMesh cage = softCube().cage;
      SoftBodyOptions options;
      options.youngsModulus = 2e4;
      options.margin = 0.002;
      // By rest positions, which are those at which it begins.
      options.pinned = held ? std::function<bool(const Vector3d&)>([turn](const Vector3d& p) {
        return (turn.transpose() * (p - Vector3d(0, 2, 0))).y() < 0.5 * kCubeEdge;
      })
                            : nullptr;
      for (Vector3d& p : cage.nodes)
        p = turn * (p + Vector3d(-0.5 * kCubeEdge, height, -0.5 * kCubeEdge)) + Vector3d(0, 2, 0);
      auto body = added(*world, cage, options);
      body->body().setActivationState(DISABLE_DEACTIVATION);
      EXPECT_TRUE(contacts->add(body->body(), softCube().shape).ok());
      return body;
    };
    lower = cube(0.0, true);
    upper = cube(kCubeEdge - 0.01 + gap, false);
  }
  /// One step.
  void step() { world->deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240); }
  void steps(int count) {
    for (int k = 0; k < count; ++k) step();
  }
  /// Moves the upper cube, without a velocity.
  void putUpper(const btVector3& by) {
    btTransform place = upper->body().getRigidTransform();
    place.getOrigin() += by;
    upper->body().transformTo(place);
  }

  std::unique_ptr<TetskinWorld> world = worldWith(btVector3(0, -10, 0));
  std::unique_ptr<SoftContacts> contacts = contactsIn(*world);
  std::unique_ptr<DeformableBody> lower, upper;
};

TEST(FollowedTouches, OfBodiesAtRestAreTheSameInEachStep) {
  TwoCubes cubes;
  cubes.steps(240);
  std::vector<SoftContact> before = cubes.contacts->contacts();
  ASSERT_GE(before.size(), 8U);
  for (int k = 0; k < 60; ++k) {
    cubes.step();
    const std::vector<SoftContact>& now = cubes.contacts->contacts();
    ASSERT_EQ(now.size(), before.size()) << k;
    for (std::size_t c = 0; c < now.size(); ++c) {
      EXPECT_EQ(now[c].body, before[c].body);
      EXPECT_LT((now[c].point - before[c].point).length(), 1e-4);
      EXPECT_GT(now[c].normal.dot(before[c].normal), 0.999);
    }
    before = now;
  }
}

TEST(FollowedTouches, EndWhenABodyIsPushedAway) {
  TwoCubes cubes;
  cubes.steps(240);
  ASSERT_FALSE(cubes.contacts->contacts().empty());
  cubes.upper->body().setVelocity(btVector3(0, 2, 0));
  cubes.steps(2);
  EXPECT_TRUE(cubes.contacts->contacts().empty());
  cubes.steps(4);
  EXPECT_TRUE(cubes.contacts->contacts().empty());
}

TEST(FollowedTouches, EndWhenABodyIsPutElsewhere) {
  // Also so near that the boxes of the bodies still overlap.
  for (const btVector3& to : {btVector3(3, 0, 0), btVector3(0, btScalar(0.01), 0)}) {
    TwoCubes cubes;
    cubes.steps(240);
    ASSERT_FALSE(cubes.contacts->contacts().empty());
    cubes.putUpper(to);
    const btVector3 before = momentumOf(cubes.upper->body());
    cubes.step();
    EXPECT_TRUE(cubes.contacts->contacts().empty()) << to.x();
    EXPECT_NEAR((momentumOf(cubes.upper->body()) - before).y(), -10.0 / 240, 1e-3) << "it falls";
  }
}

/// Half of the upper cube is then beside the lower one, and touches nothing there.
TEST(FollowedTouches, OfABodyThatIsPutAsideAreWhereItThenIs) {
  TwoCubes cubes;
  cubes.steps(240);
  ASSERT_FALSE(cubes.contacts->contacts().empty());
  cubes.putUpper(btVector3(btScalar(0.5 * kCubeEdge), btScalar(-0.001), 0));
  cubes.step();
  std::size_t beyond = 0;
  for (const SoftContact& at : cubes.contacts->contacts()) {
    EXPECT_GT(at.point.x(), -0.02);
    EXPECT_LT(at.point.x(), 0.5 * kCubeEdge);
    beyond += at.point.x() > 0.3 * kCubeEdge ? 1 : 0;
  }
  EXPECT_GT(beyond, 0U) << "the whole width is found";
}

/// A ball that rests on a plate and is thrown at it: more of its surface touches the plate in each step.
/// searched  touches are searched for in each step, since bodies that are added again have none that could be followed
double deepestOfAThrow(bool searched) {
  const auto world = worldWith(btVector3(0, -10, 0));
  const auto contacts = contactsIn(*world);
  SoftBodyOptions held;
  held.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
  TetMesh below = plate().cage;
  for (Vector3d& p : below.nodes) p.y() += 2.0;
  const auto table = added(*world, below, held);
  // The ball begins 0.08 above the lower side of its cage, and the plate ends 0.04 below the upper one of its own.
  const auto thrown = addBall(*world, Vector3d(0, 2.16 - 0.08 + 1e-3, 0));
  const auto include = [&] {
    EXPECT_TRUE(contacts->add(table->body(), plate().shape).ok());
    EXPECT_TRUE(contacts->add(thrown->body(), ball().shape).ok());
  };
  include();
  const auto next = [&] { world->deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240); };
  for (int k = 0; k < 240; ++k) next();
  thrown->body().addVelocity(btVector3(btScalar(0.3), btScalar(-3), 0));
  double depth = 0.0;
  for (int k = 0; k < 12; ++k) {
    if (searched) include();
    next();
    depth =
        std::max(depth, deepest(thrown->body(), ball().cage, ball().mesh, table->body(), plate().cage, plate().mesh));
  }
  return depth;
}

TEST(FollowedTouches, OfABodyThatIsSuddenlyThrownAreNoDeeperThanThoseOfASearchInEachStep) {
  const double wanted = deepestOfAThrow(true), followed = deepestOfAThrow(false);
  EXPECT_LT(followed, wanted + 0.0005);
}

/// Friction 0.5 holds up to 26 degrees.
TEST(FollowedTouches, OnASlopeHoldWithoutChangingTheirStates) {
  constexpr double kAngle = 10.0 * EIGEN_PI / 180.0;
  TwoCubes cubes(kAngle);
  cubes.steps(240);
  const btVector3 before = centreOf(cubes.upper->body());
  int settled = 0;
  for (int k = 0; k < 60; ++k) {
    cubes.step();
    settled += cubes.world->bodySolver().linearSolves() == 1 ? 1 : 0;
  }
  EXPECT_GE(settled, 54);
  EXPECT_LT((centreOf(cubes.upper->body()) - before).length(), 1e-4);
  EXPECT_FALSE(cubes.contacts->contacts().empty());
}

}  // namespace
}  // namespace tetskin::test
