// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Changes of a body while a skin is bound to it. These tests also run under the address sanitizer: a skin reads the
// body's nodes by index at their current address, and never reads a body that has been destroyed.
#include "worlds.h"

#include <tetskin/bullet/soft_body_skin.h>

#include "support/odd_meshes.h"

namespace tetskin {
namespace {

constexpr btScalar kSubstep = btScalar(1) / 240;

class ChangedBody : public testing::Test {
 protected:
  ChangedBody() {
    body = createSoftBody(cage, info).value();
    bind();
  }
  void bind() {
    SkinOptions options;
    options.interpolation = Interpolation::Quadratic;
    options.normals = Normals::Recomputed;
    ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
    good = surface();
  }
  std::vector<btScalar> surface() const {
    std::vector<btScalar> all;
    for (std::size_t v = 0; v < skin.positions().size(); ++v) {
      all.insert(all.end(), skin.positions()[v], skin.positions()[v] + 3);
    }
    return all;
  }
  void expectTopologyChanged() {
    EXPECT_EQ(skin.update(), StatusCode::TopologyChanged);
    EXPECT_EQ(surface(), good);
  }

  TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  TriangleMesh mesh = test::sphere(10, 0.4, Eigen::Vector3d::Constant(0.5));
  btSoftBodyWorldInfo info;
  std::unique_ptr<btSoftBody> body;
  SoftBodySkin skin;
  std::vector<btScalar> good;
};

TEST_F(ChangedBody, AppendedNodesAreNoticedWhetherTheyMoveTheOthersInMemoryOrNot) {
  for (int k = 0; k < 40; ++k) {
    body->appendNode(btVector3(0, 0, 0), 1);
    expectTopologyChanged();
  }
}

TEST_F(ChangedBody, AppendedTetsAreNoticed) {
  body->appendTetra(0, 1, 4, 10);
  expectTopologyChanged();
}

TEST_F(ChangedBody, ACutLinkIsNoticed) {
  const btSoftBody::Link& link = body->m_links[3];
  const int a = static_cast<int>(link.m_n[0] - &body->m_nodes[0]);
  const int b = static_cast<int>(link.m_n[1] - &body->m_nodes[0]);
  ASSERT_TRUE(body->cutLink(a, b, btScalar(0.5)));
  expectTopologyChanged();
}

/// Bullet appends two nodes and removes them again: the array has moved, but the number of nodes is unchanged.
TEST_F(ChangedBody, ALinkThatIsNotThereIsNotCutAndTheSkinGoesOn) {
  const btSoftBody::Node* const before = &body->m_nodes[0];
  int a = 0, b = static_cast<int>(cage.nodeCount()) - 1;  // opposite corners
  ASSERT_FALSE(body->cutLink(a, b, btScalar(0.5)));
  EXPECT_NE(&body->m_nodes[0], before);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(surface(), good);
}

TEST_F(ChangedBody, RefinementIsNoticed) {
  struct Half : btSoftBody::ImplicitFn {
    btScalar Eval(const btVector3& x) override { return x.x() - btScalar(0.3); }
  } half;
  const int before = body->m_nodes.size();
  body->refine(&half, btScalar(0.01), false);
  ASSERT_GT(body->m_nodes.size(), before);
  expectTopologyChanged();
}

TEST_F(ChangedBody, OtherMassesChangeNothing) {
  body->setVolumeMass(5);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  body->setVolumeDensity(3);
  body->setTotalMass(2);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(surface(), good);
}

TEST_F(ChangedBody, BoundAgainItIsFollowedAgain) {
  body->appendNode(btVector3(0, 0, 0), 1);
  ASSERT_EQ(skin.update(), StatusCode::TopologyChanged);
  cage.nodes.emplace_back(0, 0, 0);
  bind();
  body->translate(btVector3(1, 0, 0));
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NEAR(static_cast<double>(surface()[0] - good[0]), 1.0, 1e-5);
}

/// Bullet corrects its links and faces when its nodes have moved in memory, but not its tets.
TEST_F(ChangedBody, BoundAgainWithoutACageItSaysThatBulletsTetsDangle) {
  const auto expectRefusal = [&] {
    const btSoftBody::Node* const before = &body->m_nodes[0];
    const Result<EmbedReport> report = skin.bind(*body, mesh);
    ASSERT_EQ(report.status().code, StatusCode::IndexOutOfRange);
    for (const char* mentioned : {"appendNode", "cutLink", "48 of the body's 48 tets", "restCage"}) {
      EXPECT_NE(report.status().message.find(mentioned), std::string::npos) << report.status().message;
    }
    EXPECT_EQ(surface(), good);
    EXPECT_EQ(&body->m_nodes[0], before);
  };
  const btSoftBody::Link& link = body->m_links[3];
  ASSERT_TRUE(body->cutLink(static_cast<int>(link.m_n[0] - &body->m_nodes[0]),
                            static_cast<int>(link.m_n[1] - &body->m_nodes[0]), btScalar(0.5)));
  expectRefusal();
  body = createSoftBody(cage, info).value();
  bind();
  const btSoftBody::Node* const before = &body->m_nodes[0];
  while (&body->m_nodes[0] == before) body->appendNode(btVector3(0, 0, 0), 1);
  expectRefusal();
}

TEST_F(ChangedBody, OneThatIsGoneIsNotReadByAnythingButUpdate) {
  const Box3 box = skin.bounds();
  body.reset();
  EXPECT_EQ(surface(), good);  // the last surface is kept
  EXPECT_EQ(skin.bounds().min(), box.min());
  EXPECT_EQ(skin.normals().size(), mesh.vertexCount());
  skin.markMoved();
  ASSERT_TRUE(skin.setOrigin(btVector3(1, 0, 0)).ok());
  skin.setVisible(false);
  EXPECT_EQ(skin.update(), StatusCode::Hidden);
  SoftBodySkin moved = std::move(skin);
  body = createSoftBody(cage, info).value();
  skin = std::move(moved);
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());  // binds to another body without reading the first
  skin.setVisible(true);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
}

TEST(BodyTakenOutOfItsWorld, IsFollowedWhereverItIs) {
  TetMesh cage = test::lifted(test::latticeCage(2, 2, 2, 0.5), 1.0);
  test::DeformableWorld world(cage);
  SoftBodySkin skin;
  TriangleMesh mesh;
  mesh.positions = {{0.5, 1.5, 0.5}};
  ASSERT_TRUE(skin.bind(world.body(), cage, mesh).ok());
  world.world->stepSimulation(kSubstep, 1, kSubstep);
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  const btScalar height = skin.positions()[0][1];
  auto& deformable = static_cast<btDeformableMultiBodyDynamicsWorld&>(*world.world);
  deformable.removeSoftBody(&world.body());
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(skin.positions()[0][1], height);
  world.body().translate(btVector3(0, 2, 0));
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NEAR(static_cast<double>(skin.positions()[0][1] - height), 2.0, 1e-5);
  deformable.addSoftBody(&world.body());
}

/// With an origin near the body, a skin adds nothing to the rounding of the body's nodes.
TEST(FarFromTheOrigin, TheSurfaceIsAsExactAsTheNodes) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh mesh = test::sphere(20, 0.45, Eigen::Vector3d::Constant(0.5));
  btSoftBodyWorldInfo info;
  const std::unique_ptr<btSoftBody> body(createSoftBody(cage, info).value());
  SoftBodySkin near, far;
  ASSERT_TRUE(near.bind(*body, cage, mesh).ok());
  const btVector3 away(btScalar(1e5), btScalar(-2e5), btScalar(3e5));
  body->translate(away);
  SkinOptions options;
  options.origin = toEigen(away);
  ASSERT_TRUE(far.bind(*body, cage, mesh, options).ok());
  double nodes = 0.0, surface = 0.0, added = 0.0;
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    const Eigen::Vector3d now = toEigen(body->m_nodes[static_cast<int>(n)].m_x) - toEigen(away);
    nodes = std::max(nodes, (now - cage.nodes[n]).norm());
  }
  using Point = Eigen::Matrix<btScalar, 3, 1>;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d p = Eigen::Map<const Point>(far.positions()[v]).cast<double>();
    surface = std::max(surface, (p - mesh.positions[v]).norm());
    added = std::max(added, (p - Eigen::Map<const Point>(near.positions()[v]).cast<double>()).norm());
  }
  constexpr double kWeightRounding = 1e-7;  // weights are floats in both precisions
  EXPECT_LE(surface, 2.0 * nodes + kWeightRounding);
  EXPECT_LE(added, 2.0 * nodes + kWeightRounding * (sizeof(btScalar) == 8 ? 0.0 : 1.0));
  EXPECT_LT(added, sizeof(btScalar) == 8 ? 1e-9 : 0.1);
}

}  // namespace
}  // namespace tetskin
