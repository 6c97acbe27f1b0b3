// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// When and what Bullet updates in a render mesh, compared with this library: the defects of Bullet's path that can be
// reproduced with the installed version. The table in tests/BULLET_DEFECTS.md names these tests.
#include "bullets_render_mesh.h"
#include "worlds.h"

namespace tetskin {
namespace {

using test::figure;
using test::Points;

constexpr btScalar kFixedStep = btScalar(1) / 240;
/// A position that no update gives to a vertex.
const btVector3 kNowhere(-77, -77, -77);

TetMesh cube() {
  TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  for (Eigen::Vector3d& p : cage.nodes) p.y() += 0.5;
  return cage;
}

Points someVertices() {
  return test::randomPoints(20, {Eigen::Vector3d(0, 0.5, 0), Eigen::Vector3d(1, 1.5, 1)}, 2);
}

/// A body in one of Bullet's worlds, with its own render mesh and a skin.
template <class World>
struct Both {
  World world{cube()};
  SoftBodySkin skin;
  btSoftBody& body = world.body();
  Points vertices = someVertices();

  Both() {
    test::setRenderNodes(body, vertices);
    btSoftBodyHelpers::interpolateBarycentricWeights(&body);
    TriangleMesh mesh;
    mesh.positions = vertices;
    EXPECT_TRUE(skin.bind(body, cube(), mesh).ok());
  }
  /// Overwrites the position that Bullet last gave to its first vertex.
  void forget() { body.m_renderNodes[0].m_x = kNowhere; }
  bool bulletHasUpdated() const { return body.m_renderNodes[0].m_x != kNowhere; }
};

/// Checks after every substep whether Bullet has updated its render mesh.
class CountUpdates : public btActionInterface {
 public:
  explicit CountUpdates(Both<test::DeformableWorld>& watched) : both(watched) { both.world.world->addAction(this); }
  ~CountUpdates() override { both.world.world->removeAction(this); }
  void updateAction(btCollisionWorld*, btScalar) override {
    count += both.bulletHasUpdated();
    both.forget();
  }
  void debugDraw(btIDebugDraw*) override {}

  Both<test::DeformableWorld>& both;
  int count = 0;
};

/// Bullet updates in every substep, although only the last update of a frame is ever drawn.
TEST(BulletsUpdates, HappenInEverySubstep) {
  Both<test::DeformableWorld> both;
  CountUpdates updates(both);
  both.forget();
  ASSERT_EQ(both.world.world->stepSimulation(btScalar(10.01) * kFixedStep, 10, kFixedStep), 10);
  figure("Bullet's updates in a frame of 10 substeps", updates.count);
  EXPECT_EQ(updates.count, 10);
  EXPECT_EQ(both.skin.update(), StatusCode::Ok);  // the library's only update for this frame
}

TEST(BulletsUpdates, HappenWhileTheBodySleeps) {
  Both<test::DeformableWorld> both;
  for (int step = 0; step < 3000 && both.body.isActive(); ++step) {
    both.world.world->stepSimulation(kFixedStep, 1, kFixedStep);
    (void)both.skin.update();
  }
  ASSERT_FALSE(both.body.isActive());
  both.world.world->stepSimulation(kFixedStep, 1, kFixedStep);
  (void)both.skin.update();
  both.forget();
  both.world.world->stepSimulation(kFixedStep, 1, kFixedStep);
  EXPECT_TRUE(both.bulletHasUpdated());
  EXPECT_EQ(both.skin.update(), StatusCode::Asleep);
}

TEST(BulletsUpdates, NeverHappenInASoftRigidWorld) {
  Both<test::RigidWorld> both;
  both.forget();
  for (int step = 0; step < 100; ++step) both.world.world->stepSimulation(kFixedStep, 1, kFixedStep);
  EXPECT_FALSE(both.bulletHasUpdated());
  const double before = both.skin.bounds().min().y();
  EXPECT_EQ(both.skin.update(), StatusCode::Ok);
  EXPECT_LT(both.skin.bounds().min().y(), before - 0.1);
}

/// Bullet updates where it has moved the nodes itself; what an application moves stays behind until the next step.
TEST(BulletsUpdates, AreNotMadeByATransform) {
  Both<test::DeformableWorld> both;
  const btVector3 before = both.body.m_renderNodes[3].m_x;
  both.body.translate(btVector3(5, 0, 0));
  EXPECT_EQ(both.body.m_renderNodes[3].m_x, before);
  ASSERT_EQ(both.skin.update(), StatusCode::Ok);
  EXPECT_NEAR(static_cast<double>(both.skin.positions()[3][0]), both.vertices[3].x() + 5.0, 1e-5);
}

TEST(BulletsUpdates, NeverTouchNormals) {
  TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  btSoftBodyWorldInfo info;
  const std::unique_ptr<btSoftBody> body(createSoftBody(cage, info).value());
  TriangleMesh mesh;
  mesh.positions = {{0.5, 0.5, 0.5}};
  mesh.normals = {{0, 1, 0}};
  test::setRenderNodes(*body, mesh.positions);
  body->m_renderNodes[0].m_normal.setValue(0, 1, 0);
  btSoftBodyHelpers::interpolateBarycentricWeights(body.get());
  SkinOptions options;
  options.normals = Normals::Transformed;
  SoftBodySkin skin;
  ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
  body->rotate(btQuaternion(btVector3(0, 0, 1), btScalar(SIMD_HALF_PI)));
  body->interpolateRenderMesh();
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(body->m_renderNodes[0].m_normal, btVector3(0, 1, 0));
  EXPECT_LT((Eigen::Map<const Eigen::Vector3f>(skin.normals()[0]) - Eigen::Vector3f(-1, 0, 0)).norm(), 1e-5f);
}

}  // namespace
}  // namespace tetskin
