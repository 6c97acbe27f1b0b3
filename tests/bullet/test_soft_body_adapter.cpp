// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>

namespace tetskin {
namespace {

std::unique_ptr<btSoftBody> makeBody(const TetMesh& cage, btSoftBodyWorldInfo& info) {
  return std::unique_ptr<btSoftBody>(createSoftBody(cage, info).value());
}

TEST(SoftBodyAdapter, ReadsNodesAndTetsByIndex) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(3, 2, 1, 0.5);
  const auto body = makeBody(cage, info);
  const TetMesh read = readTetMesh(*body);
  EXPECT_EQ(read.nodes, cage.nodes);
  EXPECT_EQ(read.tets, cage.tets);
}

TEST(SoftBodyAdapter, ViewsTheCurrentPositionsInPlace) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(1, 1, 1);
  const auto body = makeBody(cage, info);
  const PointView<const btScalar> view = nodePositions(*body);
  ASSERT_EQ(view.size(), cage.nodeCount());
  body->m_nodes[5].m_x.setValue(7, 8, 9);
  EXPECT_EQ(view[5][0], 7);
  EXPECT_EQ(view[5][2], 9);
}

TEST(SoftBodyAdapter, TellsEmbeddedPointsOfItsNodes) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(2, 2, 2);
  const std::vector<Eigen::Vector3d> vertices = test::randomPoints(50, test::around(cage, 1.2), 3);
  const Embedding embedding = embed(cage, viewOf(vertices)).value();
  const auto body = makeBody(cage, info);
  body->rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.7)));
  const btVector3 turning(0, 2, 0);  // angular velocity about the origin
  for (int n = 0; n < body->m_nodes.size(); ++n) body->m_nodes[n].m_v = turning.cross(body->m_nodes[n].m_x);
  setMass(*body, 0, 0);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto point = embedding.at<btScalar>(v);
    const btVector3 turned = toBullet(vertices[v]).rotate(btVector3(0, 1, 0), btScalar(0.7));
    EXPECT_LT((point.position(positionsIn(*body)) - turned).length(), 1e-5) << v;
    EXPECT_LT((point.velocity(velocitiesIn(*body)) - turning.cross(turned)).length(), 1e-5) << v;
    btVector3 momentum(0, 0, 0), pinned(0, 0, 0);
    const btVector3 before = point.clampedVelocity(velocitiesIn(*body));
    point.applyImpulse(btVector3(1, 2, 3), inverseMassesIn(*body), [&](int node, const btVector3& change) {
      body->m_nodes[node].m_v += change;
      if (node > 0) momentum += change / body->m_nodes[node].m_im;
    });
    for (std::size_t k = 0; k < 4; ++k) {
      if (point.nodes[k] == 0) pinned = point.clampedWeights[k] * btVector3(1, 2, 3);
    }
    EXPECT_LT((momentum + pinned - btVector3(1, 2, 3)).length(), 1e-5) << v;
    const btVector3 gained = point.clampedVelocity(velocitiesIn(*body)) - before;
    const btScalar inverseMass = point.inverseMass(inverseMassesIn(*body));
    EXPECT_LT((gained - inverseMass * btVector3(1, 2, 3)).length(), 1e-5 * gained.length()) << v;
    for (std::size_t k = 0; k < 4; ++k) {
      btSoftBody::Node& node = body->m_nodes[point.nodes[k]];
      node.m_v = turning.cross(node.m_x);
    }
  }
}

TEST(SoftBodyAdapter, BodyWithoutNodesIsEmpty) {
  btSoftBodyWorldInfo info;
  const btSoftBody body(&info);
  EXPECT_TRUE(nodePositions(body).empty());
  EXPECT_TRUE(readTetMesh(body).tets.empty());
}

TEST(SoftBodyAdapter, TetsLeftDanglingByAppendedNodesAreReportedNotRead) {
  btSoftBodyWorldInfo info;
  const auto body = makeBody(test::latticeCage(1, 1, 1), info);
  const btSoftBody::Node* const before = &body->m_nodes[0];
  while (&body->m_nodes[0] == before) body->appendNode(btVector3(0, 0, 0), 1);  // until the array moves
  const TetMesh read = readTetMesh(*body);
  const TetMeshReport report = checkTetMesh(read);
  EXPECT_EQ(report.indexOutOfRange.count, read.tetCount());
  EXPECT_EQ(validate(read, report).code, StatusCode::IndexOutOfRange);
}

TEST(SoftBodyAdapter, ViewsThePositionsOfABulletVertexBuffer) {
  std::vector<float> buffer(4 * 8, -1.0f);
  btCPUVertexBufferDescriptor descriptor(buffer.data(), 2, 8, 5, 8);  // positions at offset 2, normals at 5, stride 8
  const PointView<float> view = positionView(descriptor, 4);
  view[3][1] = 42.0f;
  EXPECT_EQ(buffer[3 * 8 + 2 + 1], 42.0f);
  EXPECT_EQ(view.size(), 4u);
}

}  // namespace
}  // namespace tetskin
