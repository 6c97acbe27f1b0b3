// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/replay/snapshot.h>

#include "solver/deformable_test.h"
#include "support/bars.h"
#include "support/hollow_sphere.h"
#include "support/replays.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

/// A world, and the application's actions in each frame.
class Scene : public ReplayedScene {
 public:
  btDeformableMultiBodyDynamicsWorld& world() override { return worldOf.deformable(); }
  void frame(int number) override {
    if (before) before(number);
    step(worldOf, 1);
  }
  btSoftBody& soft(std::size_t k = 0) { return bodies[k]->body(); }

  TetskinWorld worldOf;
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::function<void(int)> before;
};

constexpr double kFarUp = 50.0;

/// A bar along x.
/// pinned  at its lower end of x
std::unique_ptr<Scene> withBar(double height, bool pinned, const SoftBodyOptions& options = {}) {
  auto scene = std::make_unique<Scene>();
  TetMesh bar = lifted(makeBox({8, 2, 2}, {2.0, 0.5, 0.5}), height);
  scene->bodies.push_back(added(scene->worldOf, bar, options));
  for (int n = 0; pinned && n < scene->soft().m_nodes.size(); ++n) {
    if (scene->soft().m_nodes[n].m_x.x() > 0) continue;
    EXPECT_TRUE(scene->bodies[0]->setPinned(n, true).ok());
  }
  return scene;
}

void spin(btSoftBody& body, btScalar rate) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v = node.m_vn = rate * btVector3(1, 2, 3).cross(node.m_x - btVector3(1, btScalar(kFarUp), 0));
  }
}

TEST(SnapshotsOfSoftBodies, OfAFreeBodyThatSpins) {
  const auto make = [] {
    auto scene = withBar(kFarUp, false);
    spin(scene->soft(), 3);
    return scene;
  };
  expectReplays(make, 40, {0, 3, 11, 25});
}

TEST(SnapshotsOfSoftBodies, OfAHeldBarThatSwings) {
  expectReplays([] { return withBar(kFarUp, true); }, 60, {0, 7, 30});
}

TEST(SnapshotsOfSoftBodies, OfAStiffBarThatSwings) {
  SoftBodyOptions stiff;
  stiff.relativeStiffness = 20000.0;
  stiff.solverTolerance = 1e-4;
  expectReplays([&] { return withBar(kFarUp, true, stiff); }, 60, {0, 7, 30});
}

TEST(SnapshotsOfSoftBodies, OfPinsThatAreLed) {
  const auto make = [] {
    auto scene = withBar(kFarUp, true);
    scene->before = [own = scene.get()](int frame) {
      const btScalar y = btScalar(0.1) * std::sin(btScalar(0.3) * static_cast<btScalar>(frame));
      for (int n = 0; n < own->soft().m_nodes.size(); ++n) {
        if (!own->bodies[0]->isPinned(n)) continue;
        btVector3 place = own->soft().m_nodes[n].m_x;
        place.setX(y);
        EXPECT_TRUE(own->bodies[0]->setPinnedPosition(n, place).ok());
      }
    };
    return scene;
  };
  expectReplays(make, 30, {0, 5, 17});
}

TEST(SnapshotsOfSoftBodies, OfABodyThatLandsAndFallsAsleep) {
  expectReplays([] { return withBar(0.1, false); }, 240, {0, 10, 60, 150, 230});
}

TEST(SnapshotsOfSoftBodies, OfABodyThatIsWoken) {
  const auto make = [] {
    auto scene = withBar(0.1, false);
    scene->before = [own = scene.get()](int frame) {
      if (frame == 230) own->soft().translate(btVector3(0, btScalar(0.1), 0));
    };
    return scene;
  };
  expectReplays(make, 250, {200, 229});
}

TEST(SnapshotsOfSoftBodies, OfQuadraticTets) {
  const auto make = [] {
    auto scene = std::make_unique<Scene>();
    TetMesh mesh = lifted(latticeCage(6, 1, 1, 0.5), 0.5);
    scene->bodies.push_back(
        DeformableBody::add(scene->world(), refineQuadratic(mesh).value(), oneKilogram(SoftBodyOptions())).value());
    return scene;
  };
  expectReplays(make, 40, {0, 9, 30});
}

TEST(SnapshotsOfSoftBodies, OfBulletsOwnForces) {
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::LinearElasticity}) {
    const auto make = [model] {
      SoftBodyOptions options;
      options.forceModel = model;
      return withBar(kFarUp, true, options);
    };
    expectReplays(make, 30, {0, 9, 20});
  }
}

TEST(SnapshotsOfSoftBodies, OfBulletsOwnForcesOnAFloor) {
  const auto make = [] {
    SoftBodyOptions options;
    options.forceModel = ForceModel::NeoHookean;
    auto scene = withBar(0.02, false, options);
    scene->soft().rotate(btQuaternion(btVector3(0, 0, 1), btScalar(0.3)));
    return scene;
  };
  expectReplays(make, 90, {0, 9, 20, 60});
}

/// Moving a body by hand turns the tree of its nodes, by which Bullet searches.
TEST(SnapshotsOfSoftBodies, WhoseTreesHaveChangedAreRefusedWhereBulletSearches) {
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  const auto bullets = withBar(0.1, false, options), ours = withBar(0.1, false);
  for (Scene* scene : {bullets.get(), ours.get()}) {
    scene->frame(0);
    const Bytes snapshot = saved(*scene);
    scene->soft().rotate(btQuaternion(btVector3(0, 0, 1), 1));
    if (scene == bullets.get()) {
      expectRefused(scene->world(), snapshot, StatusCode::SnapshotMismatch, "other trees");
    } else {
      restore(*scene, snapshot);
    }
  }
}

TEST(SnapshotsOfSoftBodies, WithOtherAnchorsAreRefused) {
  struct Anchored : Scene {
    explicit Anchored(int node) {
      bodies.push_back(added(worldOf, makeBox({8, 2, 2}, {2.0, 0.5, 0.5})));
      soft().appendDeformableAnchor(node,
                                    &rigids.add(rigids.shape<btBoxShape>(btVector3(1, 1, 1)), 1, btVector3(0, 0, 0)));
    }
    ~Anchored() override { bodies.clear(); }
    Rigids rigids{worldOf};
  };
  Anchored first(0), same(0), other(1);
  expectRefused(other.world(), saved(first), StatusCode::SnapshotMismatch, "other anchors");
  restore(same, saved(first));
}

TEST(SnapshotsOfSoftBodies, WithClustersAreNotSaved) {
  const auto scene = withBar(kFarUp, false);
  scene->soft().generateClusters(4);
  const Status status = saveSnapshot(scene->world(), nullptr, 0).status();
  EXPECT_EQ(status.code, StatusCode::NotSaved);
  EXPECT_NE(status.message.find("clusters"), std::string::npos) << status.message;
}

TEST(SnapshotsOfSoftBodies, OfSettingsThatTheApplicationChanges) {
  const auto make = [] {
    auto scene = withBar(kFarUp, true);
    scene->before = [own = scene.get()](int frame) {
      DeformableBody& body = *own->bodies[0];
      if (frame == 10) {
        EXPECT_TRUE(body.setYoungsModulus(2 * body.youngsModulus()).ok());
        EXPECT_TRUE(body.setGravity(btVector3(3, 0, 0)).ok());
        body.body().m_cfg.drag = btScalar(0.01);
        EXPECT_TRUE(body.setPinned(body.body().m_nodes.size() - 1, true).ok());
      }
      if (frame != 20) return;
      EXPECT_TRUE(body.setPinned(body.body().m_nodes.size() - 1, false).ok());
    };
    return scene;
  };
  expectReplays(make, 30, {5, 15, 25});
}

TEST(SnapshotsOfSoftBodies, OfAKinematicBoxThatIsMovedOncePerFrame) {
  struct Moved : Scene {
    Moved() {
      btRigidBody& box =
          rigids.add(rigids.shape<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.5), 1)), 0, btVector3(0, 0, 0));
      box.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      box.setActivationState(DISABLE_DEACTIVATION);
      before = [&box](int frame) {
        const auto x = btScalar(0.01) * static_cast<btScalar>(frame);
        box.setWorldTransform(placeAt(btVector3(btScalar(-0.55) + x, btScalar(0.5), 0)));
      };
      before(0);
    }
    Rigids rigids{worldOf};
  };
  const auto make = [] {
    auto scene = std::make_unique<Moved>();
    TetMesh bar = lifted(makeBox({8, 2, 2}, {2.0, 0.5, 0.5}), 0.05);
    scene->bodies.push_back(added(scene->worldOf, bar));
    return scene;
  };
  expectReplays(make, 60, {0, 20, 45});
}

TEST(SnapshotsOfSoftBodies, OfRecordedForces) {
  const auto run = [](Scene& scene, ForceRecord& record, int from, std::vector<btVector3>& forces) {
    forces.clear();
    for (int f = from; f < 40; ++f) {
      scene.frame(f);
      forces.push_back(record.forcesOn(scene.soft()).contact.force);
    }
  };
  auto scene = withBar(0.05, false);
  const auto record = ForceRecord::add(scene->world()).value();
  std::vector<btVector3> first, again;
  for (int f = 0; f < 25; ++f) scene->frame(f);
  const Bytes snapshot = saved(*scene);
  const btVector3 then = record->forcesOn(scene->soft()).contact.force;
  run(*scene, *record, 25, first);
  restore(*scene, snapshot);
  EXPECT_EQ(record->forcesOn(scene->soft()).contact.force, then);
  run(*scene, *record, 25, again);
  EXPECT_GT(then.y(), 0);
  EXPECT_EQ(first, again);
}

std::vector<btVector3> placesOf(const btSoftBody& body) {
  std::vector<btVector3> places;
  for (int n = 0; n < body.m_nodes.size(); ++n) places.push_back(body.m_nodes[n].m_x);
  return places;
}

TEST(BodiesThatReturn, AreKnownToSnapshots) {
  TetskinWorld world;
  const auto stays = added(world, smallCageAbove(2));
  const auto body = added(world, smallCageAbove(0.05));
  step(world, 20);
  std::vector<unsigned char> snapshot(saveSnapshot(world.deformable(), nullptr, 0).value());
  ASSERT_TRUE(saveSnapshot(world.deformable(), snapshot.data(), snapshot.size()).ok());
  step(world, 20);
  const auto first = placesOf(body->body()), second = placesOf(stays->body());
  body->removeFromWorld();
  step(world, 5);
  const auto restore = [&] { return restoreSnapshot(world.deformable(), snapshot.data(), snapshot.size()); };
  EXPECT_EQ(restore().code, StatusCode::SnapshotMismatch);
  ASSERT_TRUE(body->addToWorld(world.deformable()).ok());
  ASSERT_TRUE(restore().ok()) << restore().message;
  step(world, 20);
  EXPECT_EQ(placesOf(body->body()), first);
  EXPECT_EQ(placesOf(stays->body()), second);
}

/// Plastic flow, growth and a muscle of one body; what was set before a snapshot, and after it.
TEST(SnapshotsOfSoftBodies, OfBodiesWhoseRestShapesChange) {
  const auto make = [] {
    SoftBodyOptions options;
    options.youngsModulus = 2e4;
    options.stiffnessDamping = 0.005;
    auto scene = withBar(0.5, true, options);
    DeformableBody& body = *scene->bodies[0];
    Muscle muscle;
    for (int t = 0; t < body.body().m_tetras.size(); t += 2) muscle.tets.push_back(t);
    muscle.fibres = {Eigen::Vector3d(1, 0, 0)};
    muscle.stress = 4e3;
    EXPECT_TRUE(body.addMuscle(muscle).ok());
    muscle.lengthFactors = {{0.8, 0.2}, {1.0, 1.0}, {1.2, 0.0}};
    EXPECT_TRUE(body.addMuscle(muscle).ok());
    Fibres fibres;
    fibres.tets = muscle.tets;
    fibres.directions = {Eigen::Vector3d(1, 1, 0)};
    fibres.stiffness = 2e4;
    EXPECT_TRUE(body.addFibres(fibres).ok());
    scene->before = [&body](int frame) {
      Plasticity plasticity;
      plasticity.yieldStress = frame < 20 ? 200.0 : 400.0;
      plasticity.hardening = 1e3;
      plasticity.flowRate = 20.0;
      plasticity.largestStrain = 0.4;
      if (frame == 5 || frame == 20) {
        EXPECT_TRUE(body.setPlasticity(plasticity).ok());
      }
      if (frame == 30) {
        EXPECT_TRUE(body.resetPlasticFlow().ok());
      }
      if (frame == 12 || frame == 13) {
        EXPECT_TRUE(body.setGrowth(1.0 + 0.01 * (frame - 8)).ok());
      }
      if (frame == 8 || frame == 24) {
        std::vector<double> factors(static_cast<std::size_t>(body.body().m_tetras.size()), 1.0);
        if (frame == 8) factors[2] = 3.0;
        EXPECT_TRUE(body.setStiffnessScale(factors).ok());
        factors[4] = frame;
        EXPECT_TRUE(body.setDampingScale(factors).ok());
      }
      if (frame == 10 || frame == 26) {
        EXPECT_TRUE(
            body.setElasticLaw(frame == 10 ? ElasticLaw::yeoh(0.5, 0.2) : ElasticLaw::neoHookean(), {0, 1, 2}).ok());
      }
      if (frame % 4 == 0) {
        EXPECT_TRUE(body.setActivation(0, 0.02 * frame).ok());
        EXPECT_TRUE(body.setActivation(1, frame == 16 ? 0.0 : 0.5).ok());
      }
    };
    return scene;
  };
  expectReplays(make, 45, {0, 4, 6, 9, 12, 19, 25, 27, 32});
}

TEST(SnapshotsOfSoftBodies, OfBodiesUnderPressure) {
  const auto make = [] {
    auto scene = std::make_unique<Scene>();
    for (const double height : {0.5, 1.7}) {
      TetMesh cage = hollowSphere(0.4, 0.5, 1, 1);
      SoftBodyOptions options;
      options.youngsModulus = 1e5;
      scene->bodies.push_back(added(scene->worldOf, lifted(cage, height), options));
    }
    scene->before = [scene = scene.get()](int frame) {
      if (frame == 2) {
        EXPECT_TRUE(scene->bodies[0]->setGas(1e3, 1e4).ok());
      }
      if (frame == 8) {
        EXPECT_TRUE(scene->bodies[1]->setPressure(2e3).ok());
      }
      if (frame == 10) {
        for (const auto& body : scene->bodies) {
          const std::vector<double> factors(static_cast<std::size_t>(body->body().m_tetras.size()), 0.5);
          EXPECT_TRUE(body->setStiffnessScale(factors).ok());
        }
      }
      if (frame == 20) {
        EXPECT_TRUE(scene->bodies[0]->setPressure(0).ok());
      }
    };
    return scene;
  };
  expectReplays(make, 30, {0, 5, 12, 24});
}

TEST(SnapshotsOfSoftBodies, OfAGasThatSleeps) {
  auto scene = std::make_unique<Scene>();
  scene->bodies.push_back(added(scene->worldOf, latticeCage(2, 2, 2, 0.3)));
  DeformableBody& body = *scene->bodies[0];
  ASSERT_TRUE(body.setGas(50, 100).ok());
  const Bytes start = saved(*scene);
  for (int f = 0; f < 400 && scene->soft().isActive(); ++f) scene->frame(f);
  ASSERT_FALSE(scene->soft().isActive());
  const Bytes asleep = saved(*scene);
  const double pressure = body.pressure(), volume = body.volume();
  restore(*scene, start);
  EXPECT_NEAR(body.pressure(), 50, 1e-3);
  EXPECT_NE(body.volume(), volume);
  ASSERT_TRUE(body.setPressure(0).ok());
  restore(*scene, asleep);
  EXPECT_FALSE(scene->soft().isActive());
  EXPECT_EQ(body.pressure(), pressure);
  EXPECT_EQ(body.volume(), volume);
}

}  // namespace
}  // namespace tetskin::test
