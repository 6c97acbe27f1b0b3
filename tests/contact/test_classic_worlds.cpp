// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's own contact of soft bodies in the classic worlds, at the cages' surfaces, with bodies made by this library.
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>

#include "../bullet/worlds.h"
#include "support/odd_meshes.h"
#include "support/one_kilogram.h"

namespace tetskin::test {
namespace {

using Collisions = btSoftBody::fCollision;

TetMesh cubeAbove(double height) {
  return lifted(latticeCage(3, 3, 3, 0.3), height);
}

btScalar lowestOf(const btSoftBody& body) {
  btScalar y = BT_LARGE_FLOAT;
  for (int n = 0; n < body.m_nodes.size(); ++n) y = std::min(y, body.m_nodes[n].m_x.y());
  return y;
}

/// The height at which the upper of two bodies comes to rest: the lower one is 0.9 high.
template <class World, class BulletsWorld>
btScalar restingHeight(int collisions) {
  SoftBodyOptions options = test::oneKilogram();
  options.forceModel = ForceModel::MassSpring;
  options.linkStiffness = 0.9;
  World world(cubeAbove(0.05), options);
  auto& soft = static_cast<BulletsWorld&>(*world.world);
  auto upper = createSoftBody(cubeAbove(1.1), soft.getWorldInfo(), options).value();
  soft.addSoftBody(upper.get());
  for (btSoftBody* body : {&world.body(), upper.get()}) {
    body->m_cfg.collisions |= collisions;
    body->m_cfg.piterations = 4;
    if (collisions & Collisions::CL_SS) body->generateClusters(8);
  }
  for (int frame = 0; frame < 90; ++frame) soft.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  const btScalar height = lowestOf(*upper);
  soft.removeSoftBody(upper.get());
  return height;
}

btScalar inARigidWorld(int collisions) {
  return restingHeight<RigidWorld, btSoftRigidDynamicsWorld>(collisions);
}
btScalar inAMultiBodyWorld(int collisions) {
  return restingHeight<MultiBodyWorld, btSoftMultiBodyDynamicsWorld>(collisions);
}

TEST(ClassicWorlds, SoftBodiesMeetByTheirVerticesAndFaces) {
  for (const auto height : {inARigidWorld, inAMultiBodyWorld}) {
    EXPECT_LT(height(0), 0.3) << "without, they pass through each other";
    EXPECT_GT(height(Collisions::VF_SS), 0.5);
  }
}

TEST(ClassicWorlds, SoftBodiesMeetByTheirClusters) {
  for (const auto height : {inARigidWorld, inAMultiBodyWorld}) EXPECT_GT(height(Collisions::CL_SS), 0.5);
}

}  // namespace
}  // namespace tetskin::test
