// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <gtest/gtest.h>
#include <tetskin/bullet/soft_body.h>

#include <memory>

namespace tetskin {
namespace {

std::unique_ptr<btSoftBody> makeBody(const TetMesh& cage, btSoftBodyWorldInfo& info) {
  return std::unique_ptr<btSoftBody>(makeSoftBody(cage, info).value());
}

TEST(SoftBodyAdapter, ReadsNodesAndTetsByIndex) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(3, 2, 1, 0.5);
  const auto body = makeBody(cage, info);
  const TetMesh read = tetMeshOf(*body);
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

TEST(SoftBodyAdapter, BodyWithoutNodesIsEmpty) {
  btSoftBodyWorldInfo info;
  const btSoftBody body(&info);
  EXPECT_TRUE(nodePositions(body).empty());
  EXPECT_TRUE(tetMeshOf(body).tets.empty());
}

TEST(SoftBodyAdapter, TetsLeftDanglingByAppendedNodesAreReportedNotRead) {
  btSoftBodyWorldInfo info;
  const auto body = makeBody(test::latticeCage(1, 1, 1), info);
  const btSoftBody::Node* const before = &body->m_nodes[0];
  while (&body->m_nodes[0] == before) body->appendNode(btVector3(0, 0, 0), 1);  // until the array moves
  const TetMesh read = tetMeshOf(*body);
  const TetMeshReport report = checkTetMesh(read);
  EXPECT_EQ(report.indexOutOfRange.count, read.tetCount());
  EXPECT_EQ(usable(read, report).code, StatusCode::IndexOutOfRange);
}

TEST(SoftBodyAdapter, ViewsThePositionsOfABulletVertexBuffer) {
  std::vector<float> buffer(4 * 8, -1.0f);
  btCPUVertexBufferDescriptor descriptor(buffer.data(), 2, 8, 5, 8);  // positions at 2, normals at 5, stride 8
  const PointView<float> view = positionsOf(descriptor, 4);
  view[3][1] = 42.0f;
  EXPECT_EQ(buffer[3 * 8 + 2 + 1], 42.0f);
  EXPECT_EQ(view.size(), 4u);
}

}  // namespace
}  // namespace tetskin
