// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/odd_meshes.h"

#include <gtest/gtest.h>
#include <tetskin/bullet/soft_body_builder.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace tetskin {
namespace {

class Skin : public testing::Test {
 protected:
  Skin() : body(makeSoftBody(cage, info)) {}

  void bend() {
    for (int n = 0; n < body->m_nodes.size(); ++n) {
      const Eigen::Vector3d p = cage.nodes[n];
      body->m_nodes[n].m_x =
          toBullet(p + 0.2 * Eigen::Vector3d(std::sin(4 * p.y()), p.x() * p.z(), std::cos(3 * p.x())));
    }
  }

  /// Those of the sleeping body that may move unnoticed, by trying.
  std::vector<int> nodesNotLookedAt() {
    std::vector<int> unseen;
    for (int n = 0; n < body->m_nodes.size(); ++n) {
      const btVector3 here = body->m_nodes[n].m_x;
      body->m_nodes[n].m_x += btVector3(0, 1, 0);
      if (skin.update() == UpdateStatus::Asleep) unseen.push_back(n);
      body->m_nodes[n].m_x = here;
      skin.update();
    }
    return unseen;
  }

  static Eigen::Vector3d at(const SoftBodySkin& of, std::size_t v) {
    const btScalar* p = of.positions()[v];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }

  TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  TriangleMesh mesh = test::sphere(30, 0.53, Eigen::Vector3d::Constant(0.5));
  btSoftBodyWorldInfo info;
  std::unique_ptr<btSoftBody> body;
  SoftBodySkin skin;
};

constexpr double kRounding = 2e-6;

TEST_F(Skin, IsAtRestRightAfterBind) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) EXPECT_LT((at(skin, v) - mesh.positions[v]).norm(), kRounding);
}

TEST_F(Skin, BindsToTheBodyAsItIsNow) {
  body->translate(btVector3(3, 0, 0));
  for (Eigen::Vector3d& p : mesh.positions) p.x() += 3.0;
  const EmbedReport report = skin.bind(*body, mesh);
  ASSERT_TRUE(report.ok());
  EXPECT_GT(report.inside, mesh.vertexCount() / 2);
  EXPECT_LT((at(skin, 0) - mesh.positions[0]).norm(), kRounding);
}

TEST_F(Skin, RestCageServesForABodyThatHasMovedBefore) {
  body->translate(btVector3(0, 7, 0));
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((at(skin, v) - mesh.positions[v] - Eigen::Vector3d(0, 7, 0)).norm(), 4 * kRounding);
  }
}

TEST_F(Skin, RotatedScaledAndTeleportedBodyNeedsOnlyTheNextUpdate) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const btQuaternion turn(btVector3(0, 0, 1), btScalar(SIMD_HALF_PI));
  body->rotate(turn);
  body->scale(btVector3(2, 2, 2));
  body->translate(btVector3(-1, 4, 2));
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d p = mesh.positions[v];
    const Eigen::Vector3d expected = 2.0 * Eigen::Vector3d(-p.y(), p.x(), p.z()) + Eigen::Vector3d(-1, 4, 2);
    EXPECT_LT((at(skin, v) - expected).norm(), 8 * kRounding);
  }
}

TEST_F(Skin, UpdateAllocatesNothing) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  bend();
  const std::size_t before = test::allocationCount();
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_EQ(test::allocationCount(), before);
}

TEST_F(Skin, UpdateAllocatesNothingWithQuadraticSurfaceAndNormals) {
  mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
  for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
    for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
      SkinOptions options;
      options.interpolation = Interpolation::Quadratic;
      options.normals = normals;
      options.order = order;
      ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
      bend();
      const std::size_t before = test::allocationCount();
      ASSERT_EQ(skin.update(), UpdateStatus::Updated);
      EXPECT_EQ(test::allocationCount(), before);
    }
  }
}

TEST_F(Skin, QuadraticSurfaceAndNormalsAreThoseOfAMeshSkin) {
  mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
  SkinOptions options;
  options.interpolation = Interpolation::Quadratic;
  options.normals = Normals::Transformed;
  ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
  EXPECT_GT(skin.quadraticReport().nodes, cage.nodeCount() / 2);
  EXPECT_EQ(skin.quadraticReport().thinNodes, 0u);
  MeshSkin<btScalar> expected;
  ASSERT_TRUE(expected.bind(cage, mesh, options).ok());
  bend();
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  ASSERT_EQ(expected.update(nodePositions(*body)), cage.nodeCount());
  ASSERT_EQ(skin.normals().size(), mesh.vertexCount());
  ASSERT_EQ(skin.tangents().size(), mesh.vertexCount());
  const auto point = [](const auto& view, std::size_t v) { return std::array{view[v][0], view[v][1], view[v][2]}; };
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_EQ(point(skin.positions(), v), point(expected.positions(), v));
    EXPECT_EQ(point(skin.normals(), v), point(expected.normals(), v));
    EXPECT_EQ(point(skin.tangents(), v), point(expected.tangents(), v));
  }
  EXPECT_EQ(skin.bounds().min(), expected.bounds().min());
  SoftBodySkin linear;
  ASSERT_TRUE(linear.bind(*body, cage, mesh).ok());
  double difference = 0.0;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) difference += (at(skin, v) - at(linear, v)).norm();
  EXPECT_GT(difference, 1e-3 * static_cast<double>(mesh.vertexCount()));
}

TEST_F(Skin, NormalsAndTangentsTurnWithTheBody) {
  mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
  for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
    SkinOptions options;
    options.interpolation = Interpolation::Quadratic;
    options.normals = normals;
    body.reset(makeSoftBody(cage, info));
    ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
    body->rotate(btQuaternion(btVector3(0, 0, 1), btScalar(SIMD_HALF_PI)));
    ASSERT_EQ(skin.update(), UpdateStatus::Updated);
    const std::vector<Eigen::Vector3d> rest = restNormals(mesh);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const Eigen::Vector3d n = Eigen::Map<const Eigen::Vector3f>(skin.normals()[v]).cast<double>();
      EXPECT_LT((n - Eigen::Vector3d(-rest[v].y(), rest[v].x(), rest[v].z())).norm(), 1e-4);
      if (normals == Normals::Recomputed) continue;
      const Eigen::Vector3f t = Eigen::Map<const Eigen::Vector3f>(skin.tangents()[v]);
      EXPECT_LT((t - Eigen::Vector3f(0.0f, 0.6f, 0.8f)).norm(), 1e-5f);
    }
  }
}

TEST_F(Skin, HiddenSkinIsLeftAloneAndRightAtOnceWhenShown) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  EXPECT_TRUE(skin.visible());
  const Eigen::Vector3d before = at(skin, 17);
  skin.setVisible(false);
  EXPECT_FALSE(skin.visible());
  body->translate(btVector3(2, 0, 0));
  EXPECT_EQ(skin.update(), UpdateStatus::Hidden);
  EXPECT_EQ(at(skin, 17), before);
  skin.setVisible(true);  // without an update of the caller's
  EXPECT_LT((at(skin, 17) - before - Eigen::Vector3d(2, 0, 0)).norm(), 4 * kRounding);
  body->translate(btVector3(0, 3, 0));
  EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_LT((at(skin, 17) - before - Eigen::Vector3d(2, 3, 0)).norm(), 8 * kRounding);
}

TEST_F(Skin, ShownAgainIsRightEvenIfItsBodyHasFallenAsleep) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const Eigen::Vector3d before = at(skin, 17);
  skin.setVisible(false);
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    if (n % 3 != 0) body->m_nodes[n].m_x += btVector3(0, 1, 0);
  }
  body->setActivationState(ISLAND_SLEEPING);
  skin.setVisible(true);
  EXPECT_GT((at(skin, 17) - before).norm(), 0.1);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
}

TEST_F(Skin, SleepingBodyIsSkippedUntilTeleportedOrMarked) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  body->setActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
  body->translate(btVector3(1, 0, 0));
  EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
  // Nodes moved by hand are seen only if they are among the four looked at: so the caller says so.
  const Eigen::Vector3d before = at(skin, 0);
  const std::vector<int> unseen = nodesNotLookedAt();
  ASSERT_EQ(static_cast<int>(unseen.size()), body->m_nodes.size() - 4);
  for (const int n : unseen) body->m_nodes[n].m_x += btVector3(0, 1, 0);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
  EXPECT_EQ(at(skin, 0), before);
  skin.markMoved();
  EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_GT((at(skin, 0) - before).norm(), 0.1);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
}

TEST_F(Skin, SleepingBodyIsSeenToMoveInEveryAffineWay) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  body->setActivationState(ISLAND_SLEEPING);
  const auto turn = [&](const btVector3& axis, const btVector3& through) {
    const btMatrix3x3 rotation(btQuaternion(axis, btScalar(0.3)));
    body->transform(btTransform(rotation, through - rotation * through));
  };
  const std::vector<int> unseen = nodesNotLookedAt();
  std::vector<btVector3> lookedAt;
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    if (std::find(unseen.begin(), unseen.end(), n) == unseen.end()) lookedAt.push_back(body->m_nodes[n].m_x);
  }
  ASSERT_EQ(lookedAt.size(), 4u);
  // About each of its edges, whose ends stay where they are; then stretched along each axis.
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      turn((lookedAt[a] - lookedAt[b]).normalized(), lookedAt[a]);
      EXPECT_EQ(skin.update(), UpdateStatus::Updated) << a << ", " << b;
      EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
      turn((lookedAt[b] - lookedAt[a]).normalized(), lookedAt[a]);
      skin.update();
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 stretch(1, 1, 1);
    stretch[axis] = btScalar(1.5);
    body->scale(stretch);
    EXPECT_EQ(skin.update(), UpdateStatus::Updated) << axis;
    EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
  }
}

TEST_F(Skin, SeveralSkinsShareOneBodyAndSeveralBodiesOneEmbedding) {
  const TriangleMesh small = test::sphere(8, 0.3, Eigen::Vector3d::Constant(0.5));
  SoftBodySkin second, third;
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  ASSERT_TRUE(second.bind(*body, cage, small).ok());
  const std::unique_ptr<btSoftBody> other(makeSoftBody(cage, info));
  other->translate(btVector3(5, 0, 0));
  ASSERT_TRUE(third.bind(*other, skin.binding()).ok());
  EXPECT_EQ(third.binding().get(), skin.binding().get());
  bend();
  skin.update();
  second.update();
  third.update();
  EXPECT_EQ(second.positions().size(), small.vertexCount());
  EXPECT_LT((at(third, 9) - mesh.positions[9] - Eigen::Vector3d(5, 0, 0)).norm(), 8 * kRounding);
  EXPECT_GT((at(skin, 9) - mesh.positions[9]).norm(), 0.05);
}

TEST_F(Skin, WritesIntoTheCallersInterleavedBuffer) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  std::vector<float> buffer(8 * mesh.vertexCount(), -5.0f);
  const btCPUVertexBufferDescriptor descriptor(buffer.data(), 1, 8);
  SkinOptions options;
  options.target = positionsOf(descriptor, mesh.vertexCount());
  SoftBodySkin into;
  ASSERT_TRUE(into.bind(*body, cage, mesh, options).ok());
  EXPECT_TRUE(into.positions().empty());
  bend();
  skin.update();
  ASSERT_EQ(into.update(), UpdateStatus::Updated);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d p(buffer[8 * v + 1], buffer[8 * v + 2], buffer[8 * v + 3]);
    EXPECT_LT((p - at(skin, v)).norm(), kRounding);
    EXPECT_EQ(buffer[8 * v], -5.0f);
    EXPECT_EQ(buffer[8 * v + 4], -5.0f);
  }
}

TEST_F(Skin, OriginIsSubtracted) {
  std::vector<Eigen::Vector3d> points(mesh.vertexCount());
  SkinOptions options;
  options.target = viewOf(points);
  options.origin = Eigen::Vector3d(10, 20, 30);
  body->translate(btVector3(10, 20, 30));
  ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
  EXPECT_LT((points[3] - mesh.positions[3]).norm(), 16 * kRounding);
  skin.setOrigin(btVector3(9, 20, 30));
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_LT((points[3] - mesh.positions[3] - Eigen::Vector3d(1, 0, 0)).norm(), 16 * kRounding);
}

TEST_F(Skin, KeepsTheLastGoodSurfaceWhenTheSimulationExplodes) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const Eigen::Vector3d good = at(skin, 17);
  body->m_nodes[20].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  body->m_nodes[31].m_x.setZ(-std::numeric_limits<btScalar>::infinity());
  EXPECT_EQ(skin.update(), UpdateStatus::NonFinite);
  EXPECT_EQ(skin.firstBadNode(), 20u);
  EXPECT_EQ(at(skin, 17), good);
  body->m_nodes[20].m_x = toBullet(cage.nodes[20]);
  EXPECT_EQ(skin.update(), UpdateStatus::NonFinite);
  EXPECT_EQ(skin.firstBadNode(), 31u);
  body->m_nodes[31].m_x = toBullet(cage.nodes[31]);
  EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_EQ(at(skin, 17), good);
}

TEST_F(Skin, RecoversFromAnExplosionEvenIfTheBodySleepsSince) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  for (int n = 0; n < body->m_nodes.size(); ++n) body->m_nodes[n].m_x.setY(std::numeric_limits<btScalar>::quiet_NaN());
  EXPECT_EQ(skin.update(), UpdateStatus::NonFinite);
  body->setActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(skin.update(), UpdateStatus::NonFinite);
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    body->m_nodes[n].m_x = toBullet(cage.nodes[n] + Eigen::Vector3d(0, 5, 0));
  }
  EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_LT((at(skin, 17) - mesh.positions[17] - Eigen::Vector3d(0, 5, 0)).norm(), 4 * kRounding);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
}

TEST_F(Skin, RecoversFromASingleBadNodeOfASleepingBodyAboutTheOrigin) {
  // Every node but one is where it was, and their mean is 0: nothing to see in the few nodes that are looked at.
  for (Eigen::Vector3d& p : cage.nodes) p -= Eigen::Vector3d::Constant(0.5);
  for (Eigen::Vector3d& p : mesh.positions) p -= Eigen::Vector3d::Constant(0.5);
  body.reset(makeSoftBody(cage, info));
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  body->m_nodes[31].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  EXPECT_EQ(skin.update(), UpdateStatus::NonFinite);
  body->setActivationState(ISLAND_SLEEPING);
  body->m_nodes[31].m_x = toBullet(cage.nodes[31]);
  EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
}

TEST_F(Skin, NoticesAppendedNodesAndTets) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const Eigen::Vector3d good = at(skin, 17);
  body->appendNode(btVector3(0, 0, 0), 1);
  EXPECT_EQ(skin.update(), UpdateStatus::TopologyChanged);
  EXPECT_EQ(at(skin, 17), good);
  const std::unique_ptr<btSoftBody> other(makeSoftBody(cage, info));
  ASSERT_TRUE(skin.bind(*other, cage, mesh).ok());
  other->appendTetra(0, 1, 5, 25);
  EXPECT_EQ(skin.update(), UpdateStatus::TopologyChanged);
  other->setActivationState(ISLAND_SLEEPING);  // tets more or less are seen when it wakes
  EXPECT_EQ(skin.update(), UpdateStatus::Asleep);
  other->forceActivationState(ACTIVE_TAG);
  EXPECT_EQ(skin.update(), UpdateStatus::TopologyChanged);
  other->setActivationState(ISLAND_SLEEPING);
  other->appendNode(btVector3(0, 0, 0), 1);
  EXPECT_EQ(skin.update(), UpdateStatus::TopologyChanged);
}

TEST_F(Skin, UnboundSkinSaysSo) {
  EXPECT_EQ(skin.update(), UpdateStatus::Unbound);
  EXPECT_TRUE(skin.positions().empty());
  EXPECT_EQ(skin.binding(), nullptr);
}

TEST_F(Skin, FailedBindLeavesTheSkinAsItWas) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const auto binding = skin.binding();
  const auto fails = [&](const EmbedReport& report, StatusCode code, const char* mentions) {
    EXPECT_EQ(report.status.code, code);
    EXPECT_NE(report.status.message.find(mentions), std::string::npos) << report.status.message;
    EXPECT_EQ(skin.binding(), binding);
    EXPECT_EQ(skin.update(), UpdateStatus::Updated);
  };
  fails(skin.bind(*body, test::latticeCage(2, 2, 2), mesh), StatusCode::SizeMismatch, "125 nodes");
  fails(skin.bind(*body, cage, TriangleMesh{}), StatusCode::Empty, "no vertices");
  std::vector<Eigen::Vector3f> tooFew(3);
  SkinOptions options;
  options.target = viewOf(tooFew);
  fails(skin.bind(*body, cage, mesh, options), StatusCode::SizeMismatch, "3 points");
  EXPECT_EQ(skin.bind(*body, std::shared_ptr<const SoftBodyBinding>()).code, StatusCode::Empty);
  const std::unique_ptr<btSoftBody> exploded(makeSoftBody(cage, info));
  exploded->m_nodes[1].m_x.setY(std::numeric_limits<btScalar>::infinity());
  fails(skin.bind(*exploded, cage, mesh), StatusCode::NonFinite, "not finite");
}

TEST_F(Skin, PreviousPositionsAreThoseOfTheUpdateBefore) {
  SkinOptions options;
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
  const auto still = [&] { return skin.previousPositions().data() == skin.positions().data(); };
  const auto motion = [&](std::size_t v) -> double { return skin.positions()[v][1] - skin.previousPositions()[v][1]; };
  EXPECT_TRUE(still());
  body->translate(btVector3(0, 1, 0));
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_NEAR(motion(9), 1.0, 8 * kRounding);
  body->translate(btVector3(0, 2, 0));
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_NEAR(motion(9), 2.0, 8 * kRounding);

  body->setActivationState(ISLAND_SLEEPING);
  ASSERT_EQ(skin.update(), UpdateStatus::Asleep);
  EXPECT_TRUE(still());
  body->setActivationState(ACTIVE_TAG);
  body->translate(btVector3(0, 3, 0));
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_NEAR(motion(9), 3.0, 16 * kRounding);

  skin.setVisible(false);
  body->translate(btVector3(0, 4, 0));
  ASSERT_EQ(skin.update(), UpdateStatus::Hidden);
  EXPECT_TRUE(still());
  skin.setVisible(true);
  EXPECT_TRUE(still());
  EXPECT_NEAR(static_cast<double>(skin.positions()[9][1]), mesh.positions[9].y() + 10.0, 16 * kRounding);

  const btScalar good = body->m_nodes[20].m_x.x();
  body->translate(btVector3(0, 1, 0));
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  body->m_nodes[20].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  ASSERT_EQ(skin.update(), UpdateStatus::NonFinite);
  EXPECT_TRUE(still());
  body->m_nodes[20].m_x.setX(good);
  ASSERT_EQ(skin.update(), UpdateStatus::Updated);
  EXPECT_NEAR(motion(9), 0.0, 16 * kRounding);
}

TEST_F(Skin, EveryUpdateStatusHasAName) {
  EXPECT_STREQ(toString(UpdateStatus::Updated), "updated");
  EXPECT_STREQ(toString(UpdateStatus::Asleep), "asleep");
  EXPECT_STREQ(toString(UpdateStatus::Hidden), "hidden");
  EXPECT_STREQ(toString(UpdateStatus::NonFinite), "not finite");
  EXPECT_STREQ(toString(UpdateStatus::TopologyChanged), "topology changed");
  EXPECT_STREQ(toString(UpdateStatus::Unbound), "unbound");
}

}  // namespace
}  // namespace tetskin
