// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One body with Bullet's own render mesh and with a skin, side by side.
#pragma once

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <gtest/gtest.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "support/odd_meshes.h"

namespace tetskin::test {

using Points = std::vector<Eigen::Vector3d>;

/// A point rounded to Bullet's precision.
inline Eigen::Vector3d inBulletsPrecision(const Eigen::Vector3d& p) {
  return toEigen(toBullet(p));
}

/// Sets render nodes at these points, not yet bound to anything.
inline void setRenderNodes(btSoftBody& body, const Points& points) {
  body.m_renderNodes.resize(0);
  for (const Eigen::Vector3d& p : points) {
    btSoftBody::RenderNode node;
    node.m_x = toBullet(p);
    node.m_uv1.setZero();
    node.m_normal.setZero();
    body.m_renderNodes.push_back(node);
  }
}

/// Prints a measured figure, for the table in tests/BULLET_DEFECTS.md.
inline void figure(const char* what, double value) {
  std::printf("[  figure  ] %s: %.3g\n", what, value);
}

class RenderMeshes : public testing::Test {
 protected:
  void make(const TetMesh& restCage) {
    cage = restCage;
    for (Eigen::Vector3d& p : cage.nodes) p = inBulletsPrecision(p);
    body = createSoftBody(cage, info).value();
    ASSERT_TRUE(body);
  }
  /// Binds both to these vertices, where the body is now.
  void bindBoth(Points points, const SkinOptions& options = {}) {
    vertices = std::move(points);
    for (Eigen::Vector3d& p : vertices) p = inBulletsPrecision(p);
    setRenderNodes(*body, vertices);
    btSoftBodyHelpers::interpolateBarycentricWeights(body.get());
    ASSERT_TRUE(skin.bind(*body, readTetMesh(*body), meshOf(vertices), options).ok());
  }
  void updateBoth() {
    body->interpolateRenderMesh();
    ASSERT_EQ(skin.update(), StatusCode::Ok);
  }

  static TriangleMesh meshOf(const Points& points) {
    TriangleMesh mesh;
    mesh.positions = points;
    return mesh;
  }
  Eigen::Vector3d bullets(int v) const { return toEigen(body->m_renderNodes[v].m_x); }
  Eigen::Vector3d ours(int v) const {
    const btScalar* p = skin.positions()[static_cast<std::size_t>(v)];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
  int count() const { return static_cast<int>(vertices.size()); }

  btSoftBodyWorldInfo info;
  TetMesh cage;
  Points vertices;
  std::unique_ptr<btSoftBody> body;
  SoftBodySkin skin;
};

}  // namespace tetskin::test
