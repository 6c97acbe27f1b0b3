// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "skin_test.h"
#include "support/allocation_count.h"

#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>

namespace tetskin::test {
namespace {

class Skin : public test::SkinTest {};

TEST_F(Skin, IsAtRestRightAfterBind) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) EXPECT_LT((at(skin, v) - mesh.positions[v]).norm(), kRounding);
}

TEST_F(Skin, BindsToTheBodyAsItIsNow) {
  body->translate(btVector3(3, 0, 0));
  for (Eigen::Vector3d& p : mesh.positions) p.x() += 3.0;
  const Result<EmbedReport> report = skin.bind(*body, mesh);
  ASSERT_TRUE(report.ok());
  EXPECT_GT(report.value().inside, mesh.vertexCount() / 2);
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
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d p = mesh.positions[v];
    const Eigen::Vector3d expected = 2.0 * Eigen::Vector3d(-p.y(), p.x(), p.z()) + Eigen::Vector3d(-1, 4, 2);
    EXPECT_LT((at(skin, v) - expected).norm(), 8 * kRounding);
  }
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
      ASSERT_EQ(skin.update(), StatusCode::Ok);
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
  EXPECT_GT(skin.binding()->quadraticReport().nodes, cage.nodeCount() / 2);
  EXPECT_EQ(skin.binding()->quadraticReport().underdeterminedNodes, 0u);
  MeshSkin<btScalar> expected;
  ASSERT_TRUE(expected.bind(cage, mesh, options).ok());
  bend();
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  ASSERT_EQ(expected.update(nodePositions(*body)), StatusCode::Ok);
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

TEST_F(Skin, SeveralSkinsShareOneBodyAndSeveralBodiesOneEmbedding) {
  const TriangleMesh small = test::sphere(8, 0.3, Eigen::Vector3d::Constant(0.5));
  SoftBodySkin second, third;
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  ASSERT_TRUE(second.bind(*body, cage, small).ok());
  const std::unique_ptr<btSoftBody> other(createSoftBody(cage, info).value());
  other->translate(btVector3(5, 0, 0));
  ASSERT_TRUE(third.bind(*other, skin.binding()).ok());
  EXPECT_EQ(third.binding().get(), skin.binding().get());
  bend();
  (void)skin.update();
  (void)second.update();
  (void)third.update();
  EXPECT_EQ(second.positions().size(), small.vertexCount());
  EXPECT_LT((at(third, 9) - mesh.positions[9] - Eigen::Vector3d(5, 0, 0)).norm(), 8 * kRounding);
  EXPECT_GT((at(skin, 9) - mesh.positions[9]).norm(), 0.05);
}

TEST_F(Skin, WritesIntoTheCallersInterleavedBuffer) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  std::vector<float> buffer(8 * mesh.vertexCount(), -5.0f);
  const btCPUVertexBufferDescriptor descriptor(buffer.data(), 1, 8);
  SkinOptions options;
  options.target = positionView(descriptor, mesh.vertexCount());
  SoftBodySkin into;
  ASSERT_TRUE(into.bind(*body, cage, mesh, options).ok());
  EXPECT_TRUE(into.positions().empty());
  bend();
  (void)skin.update();
  ASSERT_EQ(into.update(), StatusCode::Ok);
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
  ASSERT_TRUE(skin.setOrigin(btVector3(9, 20, 30)).ok());
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_LT((points[3] - mesh.positions[3] - Eigen::Vector3d(1, 0, 0)).norm(), 16 * kRounding);
  EXPECT_FALSE(skin.setOrigin(btVector3(9, std::numeric_limits<btScalar>::quiet_NaN(), 30)).ok());
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_LT((points[3] - mesh.positions[3] - Eigen::Vector3d(1, 0, 0)).norm(), 16 * kRounding);
}

TEST_F(Skin, FailedBindLeavesTheSkinAsItWas) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const auto binding = skin.binding();
  const auto fails = [&](const Result<EmbedReport>& report, StatusCode code, const char* mentions) {
    EXPECT_EQ(report.status().code, code);
    EXPECT_NE(report.status().message.find(mentions), std::string::npos) << report.status().message;
    EXPECT_EQ(skin.binding(), binding);
    EXPECT_EQ(skin.update(), StatusCode::Ok);
  };
  fails(skin.bind(*body, test::latticeCage(2, 2, 2), mesh), StatusCode::SizeMismatch, "125 nodes");
  fails(skin.bind(*body, cage, TriangleMesh{}), StatusCode::Empty, "no vertices");
  std::vector<Eigen::Vector3f> tooFew(3);
  SkinOptions options;
  options.target = viewOf(tooFew);
  fails(skin.bind(*body, cage, mesh, options), StatusCode::SizeMismatch, "3 points");
  EXPECT_EQ(skin.bind(*body, std::shared_ptr<const SoftBodyBinding>()).code, StatusCode::Empty);
  const std::unique_ptr<btSoftBody> exploded(createSoftBody(cage, info).value());
  exploded->m_nodes[1].m_x.setY(std::numeric_limits<btScalar>::infinity());
  fails(skin.bind(*exploded, cage, mesh), StatusCode::NonFinite, "not finite");
}

}  // namespace
}  // namespace tetskin::test
