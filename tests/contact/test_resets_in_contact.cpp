// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies that are reset or teleported while they touch others.
#include <tetskin/contact/surface_contact.h>
#include <tetskin/replay/recorder.h>
#include <tetskin/solver/src/base/body_channel.h>

#include <cstdio>
#include <filesystem>

#include "soft_fixtures.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

constexpr btScalar kStepOfResets = btScalar(1) / 60;

/// Balls that fall onto a pinned plate, and one beside, onto the floor: by their surfaces.
struct LandingBalls {
  tetskin::DeformableWorld world;
  Rigid floor{world, std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0, btVector3(0, 0, 0)};
  std::unique_ptr<SoftContacts> contacts = SoftContacts::add(world).value();
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::vector<std::unique_ptr<SurfaceContact>> surfaces;

  LandingBalls() {
    static const std::shared_ptr<const ContactShape> coarse = ball().makeShape({600, 24});
    add(plate().cage, plate().mesh, Vector3d(0, 0.5, 0), plate().shape, true);
    add(ball().cage, ball().mesh, Vector3d(0, 0.7, 0), coarse, false);
    add(ball().cage, ball().mesh, Vector3d(0.2, 1.7, 0.1), coarse, false);
    add(ball().cage, ball().mesh, Vector3d(3, 0.2, 0), coarse, false);
  }
  void add(TetMesh cage, const TriangleMesh& mesh, const Vector3d& at, const std::shared_ptr<const ContactShape>& shape,
           bool held) {
    const auto binding = SoftBodyBinding::create(cage, mesh).value();
    for (Vector3d& p : cage.nodes) p += at;
    SoftBodyOptions options;
    options.youngsModulus = 3000;
    if (held) options.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(0.01, 9, 9)));
    bodies.push_back(DeformableBody::add(world, cage, oneKilogram(options)).value());
    EXPECT_TRUE(contacts->add(bodies.back()->body(), shape).ok());
    surfaces.push_back(SurfaceContact::add(world, bodies.back()->body(), *binding, mesh).value());
  }
  void frame() { world.stepSimulation(kStepOfResets, 4, kStepOfResets / 4); }
  std::vector<btScalar> motion() const { return motionOf(bodies); }
};

/// With this the box in the broadphase covers the surface's next position: otherwise fast bodies pass through thin
/// objects.
TEST(ResetsInContact, KeepTheReachOfASurface) {
  LandingBalls scene;
  const auto reachOf = [](DeformableBody& body) { return bullet_detail::channelOf(body.body())->reach(); };
  const btScalar reach = reachOf(*scene.bodies[1]);
  ASSERT_GT(reach, 0);
  scene.frame();
  ASSERT_TRUE(scene.bodies[1]->reset().ok());
  EXPECT_EQ(reachOf(*scene.bodies[1]), reach);
}

TEST(ResetsInContact, OfAllBodiesRepeatTheRun) {
  LandingBalls scene;
  std::vector<std::vector<btScalar>> first;
  std::size_t touches = 0;
  for (int frame = 0; frame < 60; ++frame) {
    scene.frame();
    first.push_back(scene.motion());
    touches += scene.contacts->contacts().size();
  }
  ASSERT_GT(touches, 0u);
  for (const auto& body : scene.bodies) ASSERT_TRUE(body->reset().ok());
  EXPECT_EQ(scene.contacts->contacts().size(), 0u);
  for (std::size_t frame = 0; frame < first.size(); ++frame) {
    scene.frame();
    ASSERT_EQ(scene.motion(), first[frame]) << "frame " << frame;
  }
}

TEST(ResetsInContact, AreRecordedAndPlayed) {
  const std::string path = testing::TempDir() + "resets_in_contact.replay";
  std::vector<std::vector<btScalar>> motions;
  {
    LandingBalls scene;
    const auto recorder = Recorder::start(scene.world, path).value();
    for (int frame = 0; frame < 50; ++frame) {
      if (frame == 30) {
        ASSERT_TRUE(scene.bodies[1]->reset().ok());
      }
      const btTransform motion(btQuaternion(btVector3(0, 1, 0), 1), btVector3(1, btScalar(0.3), 2));
      if (frame == 35) {
        ASSERT_TRUE(scene.bodies[3]->teleport(motion).ok());
      }
      if (frame == 40) {
        ASSERT_TRUE(shiftOrigin(scene.world, btVector3(16, 0, 0)).ok());
      }
      recorder->step(kStepOfResets, 4, kStepOfResets / 4);
      motions.push_back(scene.motion());
    }
    ASSERT_TRUE(recorder->status().ok()) << recorder->status().message;
  }
  {
    LandingBalls scene;
    const auto replay = Replay::open(scene.world, path).value();
    for (const auto& motion : motions) {
      ASSERT_TRUE(replay->step()) << replay->status().message;
      ASSERT_EQ(scene.motion(), motion) << "step " << replay->report().steps << ' ' << replay->report().object;
    }
  }
  std::filesystem::remove(path);
}

/// Friction would otherwise pull a body on the floor back to where it stuck.
TEST(TeleportsInContact, LeaveNoPullBehind) {
  LandingBalls scene, beside;
  const auto frames = [&](int count) {
    for (int frame = 0; frame < count; ++frame) {
      scene.frame();
      beside.frame();
    }
  };
  const auto meanX = [](const LandingBalls& of) {
    const btSoftBody& soft = of.bodies[3]->body();
    double sum = 0;
    for (int n = 0; n < soft.m_nodes.size(); ++n) sum += static_cast<double>(soft.m_nodes[n].m_x.x());
    return sum / soft.m_nodes.size();
  };
  frames(150);
  const btVector3 by(btScalar(0.01), 0, 0);
  ASSERT_TRUE(scene.bodies[3]->teleport(btTransform(btQuaternion::getIdentity(), by)).ok());
  frames(30);
  EXPECT_NEAR(meanX(scene) - meanX(beside), 0.01, 1e-5);
}

}  // namespace
}  // namespace tetskin::test
