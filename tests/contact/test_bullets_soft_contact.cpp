// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How Bullet's own contact between soft bodies of a deformable world fails, as far as this can be reproduced with the
// installed version. The table in tests/BULLET_DEFECTS.md names these tests.
#include "bullets_figure.h"
#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Collisions = btSoftBody::fCollision;

constexpr btScalar kStep = btScalar(1) / 240;

TetMesh cubeAt(const Vector3d& at) {
  TetMesh cage = latticeCage(3, 3, 3, 0.3);
  for (Vector3d& p : cage.nodes) p += at;
  return cage;
}

/// The cube's render surface is its cage.
const std::shared_ptr<const ContactShape>& cubeShape() {
  static const std::shared_ptr<const ContactShape> shape = [] {
    const TetMesh cage = cubeAt(Vector3d::Zero());
    TriangleMesh mesh;
    mesh.positions = cage.nodes;
    mesh.triangles = boundaryFaces(cage);
    ContactShapeOptions options;
    options.sampleCount = 1000;
    options.gridResolution = 32;
    return ContactShape::create(cage, mesh, options).value();
  }();
  return shape;
}

/// A cube and another one nearly above it, 0.1 away. The options' pinned nodes belong to the lower one.
struct TwoCubes {
  explicit TwoCubes(int collisions, double height = 5.0, SoftBodyOptions options = {},
                    ForceModel model = ForceModel::NeoHookean)
      : made(worldFor(model)) {
    options.forceModel = model;
    lower = added(world, cubeAt({0, height, 0}), options);
    options.pinned = {};
    upper = added(world, cubeAt({0.1, height + 1.0, 0.07}), options);
    for (DeformableBody* body : {lower.get(), upper.get()}) {
      body->body().m_cfg.collisions |= collisions;
      if (collisions & Collisions::CL_SS) body->body().generateClusters(8);
    }
  }
  void floatFreely() {
    for (DeformableBody* body : {lower.get(), upper.get()}) EXPECT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());
  }
  btScalar apart() const { return centreOf(upper->body()).y() - centreOf(lower->body()).y(); }

  std::unique_ptr<EmptyWorld> made;
  EmptyWorld& world = *made;
  std::unique_ptr<DeformableBody> lower, upper;
};

/// The final distance between a cube and one that falls on it; the lower one is pinned. Less than 0: they have passed
/// through each other.
btScalar restingOn(int collisions) {
  SoftBodyOptions held;
  held.pinned = [](const Vector3d&) { return true; };
  TwoCubes cubes(collisions, 5.0, held);
  step(cubes.world, 50);
  return cubes.apart();
}

/// These kinds of collision belong to the classic worlds.
TEST(BulletsSoftContact, HasKindsThatDoNothingInADeformableWorld) {
  EXPECT_LT(restingOn(Collisions::VF_SS), 0);
  EXPECT_LT(restingOn(Collisions::CL_SS), 0);
  EXPECT_GT(restingOn(Collisions::VF_DD), btScalar(0.5)) << "the one that does something";
}

TEST(BulletsSoftContact, IsOffWhereTwoKindsAreAskedFor) {
  EXPECT_LT(restingOn(Collisions::VF_DD | Collisions::VF_SS), 0);
}

/// How two cubes collide with each other.
enum class PairState { Nothing, Bullets, Ours };

/// The largest speed of two stiff cubes on the floor after one was thrown onto the other, relative to the impact speed.
double wildest(double speed, PairState pairState) {
  SoftBodyOptions options;
  options.youngsModulus = 20000;
  const bool ours = pairState == PairState::Ours;
  TwoCubes cubes(pairState == PairState::Bullets ? Collisions::VF_DD : 0, 0.1, options,
                 ours ? ForceModel::Corotated : ForceModel::NeoHookean);
  std::unique_ptr<SoftContacts> contacts;
  if (ours) {
    contacts = contactsIn(cubes.world);
    EXPECT_TRUE(contacts->add(cubes.lower->body(), cubeShape()).ok());
    EXPECT_TRUE(contacts->add(cubes.upper->body(), cubeShape()).ok());
  }
  cubes.upper->body().setVelocity(btVector3(0, static_cast<btScalar>(-speed), 0));
  double maximum = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    step(cubes.world, 1);
    maximum = std::max({maximum, rmsSpeed(cubes.lower->body()), rmsSpeed(cubes.upper->body())});
  }
  return maximum / speed;
}

TEST(BulletsSoftContact, ExplodesWhereStiffBodiesMeetFast) {
  double maximum[3] = {};
  for (const double speed : {10.0, 12.0, 14.0, 15.0, 16.0, 18.0, 20.0}) {
    for (const PairState pairState : {PairState::Nothing, PairState::Bullets, PairState::Ours}) {
      double& value = maximum[static_cast<int>(pairState)];
      value = std::max(value, wildest(speed, pairState));
    }
  }
  figure("speed over that of the impact, VF_DD", maximum[1]);
  figure("speed over that of the impact, ours", maximum[2]);
  EXPECT_LT(maximum[0], 1.2) << "the force alone bears it";
  EXPECT_GT(maximum[1], 2.0);
  EXPECT_LT(maximum[2], 1.1);
}

/// Contacts found by continuous detection are appended to one list, but the solver reads another.
TEST(BulletsSoftContact, FindsFastContactsAndForgetsThem) {
  TwoCubes cubes(Collisions::VF_DD);
  cubes.floatFreely();
  cubes.upper->body().setVelocity(btVector3(0, -60, 0));
  int found = 0;
  for (int k = 0; k < 20; ++k) {
    cubes.world.deformable().stepSimulation(kStep, 0);
    found += cubes.lower->body().m_faceNodeContactsCCD.size() + cubes.upper->body().m_faceNodeContactsCCD.size();
  }
  figure("contacts found by continuous detection", found);
  EXPECT_GT(found, 0);
  EXPECT_LT(cubes.apart(), -0.9) << "they have passed through each other";
}

/// This happens with the world's projection on, without which bodies hang in the air.
TEST(BulletsSoftContact, LetsFacesFallThroughTheFloor) {
  EmptyWorld world;
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  const auto body = added(world, cubeAt({0, 0.1, 0}), options);
  body->body().m_cfg.collisions = Collisions::SDF_RDF;
  step(world, 60);
  EXPECT_LT(lowest(body->body()), -1.0);
  const auto byNodes = added(world, cubeAt({3, 0.1, 0}), options);
  step(world, 60);
  EXPECT_GT(lowest(byNodes->body()), 0.0);
}

/// A body made by createSoftBody under Bullet's own force. SurfaceContact.FallsAsleep... tests what `DeformableBody`
/// does instead.
TEST(BulletsSoftContact, JumpsWhenItFallsAsleep) {
  DeformableWorld world(cubeAt({0, 0.1, 0}));
  btSoftBody& soft = world.body();
  std::vector<btVector3> before(static_cast<std::size_t>(soft.m_nodes.size()));
  for (int k = 0; k < 3000 && soft.isActive(); ++k) {
    for (int n = 0; n < soft.m_nodes.size(); ++n) before[static_cast<std::size_t>(n)] = soft.m_nodes[n].m_x;
    world.world->stepSimulation(kStep, 0);
  }
  ASSERT_FALSE(soft.isActive());
  world.world->stepSimulation(kStep, 0);
  double jump = 0.0;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    jump = std::max<double>(jump, (soft.m_nodes[n].m_x - before[static_cast<std::size_t>(n)]).length());
  }
  figure("jump of a node over the body's size", jump / 0.9);
  EXPECT_GT(jump / 0.9, 0.001);
}

}  // namespace
}  // namespace tetskin::test
