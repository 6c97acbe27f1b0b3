// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The first page's claims about Bullet's render mesh, compared with the library's skin, which has none of these
// defects.
#include "bullets_render_mesh.h"
#include "worlds.h"

namespace tetskin {
namespace {

constexpr btScalar kFixedStep = btScalar(1) / 240;
/// A position that no update gives to a vertex.
const btVector3 kNowhere(-77, -77, -77);

/// Binds a body's render nodes by Bullet, and a skin to the same points.
void bindBoth(btSoftBody& body, const TriangleMesh& mesh, SoftBodySkin& skin, const SkinOptions& options = {}) {
  test::setRenderNodes(body, mesh.positions);
  btSoftBodyHelpers::interpolateBarycentricWeights(&body);
  ASSERT_TRUE(skin.bind(body, readTetMesh(body), mesh, options).ok());
}

/// Bullet binds no vertex that is farther than 1,000 altitudes from every tet, and draws it at the world's origin.
TEST(BulletsRenderMesh, DrawsAFarVertexAtTheOrigin) {
  btSoftBodyWorldInfo info;
  const std::unique_ptr<btSoftBody> body = createSoftBody(test::latticeCage(4, 4, 4, 0.25), info).value();
  TriangleMesh mesh;
  mesh.positions = {{400.0, 0.3, 0.4}};
  SoftBodySkin skin;
  bindBoth(*body, mesh, skin);
  EXPECT_EQ(body->m_renderNodesParents[0].size(), 0);
  body->translate(btVector3(0, 2, 0));
  body->interpolateRenderMesh();
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_TRUE(body->m_renderNodes[0].m_x.isZero());
  EXPECT_NEAR(static_cast<double>(skin.positions()[0][1]), 2.3, 1e-2);
}

/// Although only the last update of a frame is ever drawn; and also while the body sleeps.
TEST(BulletsRenderMesh, IsUpdatedInEverySubstep) {
  struct Counter : btActionInterface {
    explicit Counter(btSoftBody& counted) : body(counted) {}
    void updateAction(btCollisionWorld*, btScalar) override {
      count += body.m_renderNodes[0].m_x != kNowhere;
      body.m_renderNodes[0].m_x = kNowhere;
    }
    void debugDraw(btIDebugDraw*) override {}
    btSoftBody& body;
    int count = 0;
  };
  test::DeformableWorld world(test::latticeCage(3, 3, 3, 1.0 / 3.0));
  TriangleMesh mesh;
  mesh.positions = {{0.5, 0.5, 0.5}};
  SoftBodySkin skin;
  bindBoth(world.body(), mesh, skin);
  Counter counter(world.body());
  world.world->addAction(&counter);
  for (const bool asleep : {false, true}) {
    if (asleep) world.body().forceActivationState(ISLAND_SLEEPING);
    world.body().m_renderNodes[0].m_x = kNowhere;
    counter.count = 0;
    ASSERT_EQ(world.world->stepSimulation(btScalar(10.01) * kFixedStep, 10, kFixedStep), 10);
    EXPECT_EQ(counter.count, 10);
    EXPECT_EQ(skin.update(), StatusCode::Ok);
    EXPECT_EQ(skin.update(), asleep ? StatusCode::Asleep : StatusCode::Ok);
  }
  world.world->removeAction(&counter);
}

TEST(BulletsRenderMesh, KeepsItsNormalsAtRest) {
  btSoftBodyWorldInfo info;
  const std::unique_ptr<btSoftBody> body = createSoftBody(test::latticeCage(2, 2, 2, 0.5), info).value();
  TriangleMesh mesh;
  mesh.positions = {{0.5, 0.5, 0.5}};
  mesh.normals = {{0, 1, 0}};
  SkinOptions options;
  options.normals = Normals::Transformed;
  SoftBodySkin skin;
  bindBoth(*body, mesh, skin, options);
  body->m_renderNodes[0].m_normal.setValue(0, 1, 0);
  body->rotate(btQuaternion(btVector3(0, 0, 1), btScalar(SIMD_HALF_PI)));
  body->interpolateRenderMesh();
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(body->m_renderNodes[0].m_normal, btVector3(0, 1, 0));
  EXPECT_LT((Eigen::Map<const Eigen::Vector3f>(skin.normals()[0]) - Eigen::Vector3f(-1, 0, 0)).norm(), 1e-5f);
}

}  // namespace
}  // namespace tetskin
