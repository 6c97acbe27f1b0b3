// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How Bullet binds a render mesh to tets or faces, compared with this library: where both agree, and the defects of
// Bullet's path that can be reproduced with the installed version. The table in tests/BULLET_DEFECTS.md names these
// tests.
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <cmath>

#include "bullets_render_mesh.h"

namespace tetskin {
namespace {

using test::figure;
using test::Points;

constexpr bool kDouble = sizeof(btScalar) == 8;
/// The approximate thickness of slivers relative to their size.
constexpr double kThickness = 1e-3;

class BulletsBinding : public test::RenderMeshes {
 protected:
  /// The tet that Bullet chose, identified by its nodes; -1 if none.
  int bulletsTet(int v) const {
    const auto& parents = body->m_renderNodesParents[v];
    if (parents.size() != 4) return -1;
    Tet tet{};
    for (int k = 0; k < 4; ++k) tet[k] = static_cast<int>(parents[k] - &body->m_nodes[0]);
    const auto found = std::find(cage.tets.begin(), cage.tets.end(), tet);
    return found == cage.tets.end() ? -1 : static_cast<int>(found - cage.tets.begin());
  }
  double barycentric(int tet, const Eigen::Vector3d& v) const {
    return barycentricDistance(BarycentricMap(cornersOf(cage, cage.tets[tet]))(v));
  }
  double bulletsWeightSum(int v) const {
    const btVector4 w = body->m_renderNodesInterpolationWeights[v];
    return static_cast<double>(w[0] + w[1] + w[2] + w[3]);
  }
};

TEST_F(BulletsBinding, AgreesWithOursOnGoodCages) {
  // The cage is irregular because in a lattice several tets are equally good for a vertex outside.
  TetMesh irregular = test::latticeCage(4, 4, 4, 0.25);
  const auto noise =
      test::randomPoints(irregular.nodeCount(), {Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.06)}, 5);
  for (std::size_t n = 0; n < irregular.nodeCount(); ++n) irregular.nodes[n] += noise[n];
  make(irregular);
  SkinOptions options;
  options.outside = OutsideRule::Barycentric;
  bindBoth(test::randomPoints(3000, {Eigen::Vector3d::Constant(-0.15), Eigen::Vector3d::Constant(1.15)}, 3), options);
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    btVector3& p = body->m_nodes[n].m_x;
    p += btScalar(0.2) * btVector3(btSin(4 * p.y()), p.x() * p.z(), btCos(3 * p.x()));
  }
  updateBoth();
  const auto bindings = skin.binding()->embedding().bindings();
  int otherTets = 0;
  for (int v = 0; v < count(); ++v) {
    const int tet = bulletsTet(v);
    ASSERT_GE(tet, 0);
    if (tet != bindings[v].tet) {
      // Bullet decides in its own precision: it may choose differently where two tets are equally good.
      EXPECT_NEAR(barycentric(tet, vertices[v]), barycentric(bindings[v].tet, vertices[v]), 1e-5);
      ++otherTets;
      continue;
    }
    EXPECT_LT((bullets(v) - ours(v)).norm(), 1e-5) << "vertex " << v;
  }
  EXPECT_LE(otherTets, kDouble ? 0 : 3);
}

/// Bullet binds no vertex that is farther than 1,000 altitudes from every tet, and draws it at the world's origin.
TEST_F(BulletsBinding, DrawsAFarVertexAtTheOrigin) {
  make(test::latticeCage(4, 4, 4, 0.25));
  bindBoth({{400.0, 0.3, 0.4}});
  EXPECT_EQ(body->m_renderNodesParents[0].size(), 0);
  body->translate(btVector3(0, 2, 0));
  updateBoth();
  EXPECT_EQ(bullets(0), Eigen::Vector3d::Zero());
  EXPECT_LT((ours(0) - Eigen::Vector3d(400.0, 2.3, 0.4)).norm(), 1e-2);
}

/// Bullet draws a vertex at the world's origin also where a body has no tets, only faces and links, such as a cloth.
/// This library refuses such a body and says why.
TEST_F(BulletsBinding, DrawsABodyWithoutTetsAtTheOrigin) {
  make(test::latticeCage(1, 1, 1));
  while (body->m_tetras.size() > 0) body->m_tetras.pop_back();
  test::setRenderNodes(*body, {{0.5, 0.5, 0.5}});
  btSoftBodyHelpers::interpolateBarycentricWeights(body.get());
  body->interpolateRenderMesh();
  EXPECT_EQ(bullets(0), Eigen::Vector3d::Zero());
  const Result<EmbedReport> report = skin.bind(*body, meshOf({{0.5, 0.5, 0.5}}));
  EXPECT_EQ(report.status().code, StatusCode::Empty);
  EXPECT_FALSE(report.status().message.empty());
}

/// The only tet of each body has no volume except for rounding, and Bullet divides by that volume.
TEST_F(BulletsBinding, TakesFlatTetsAndStoresWeightsThatAreNotNumbers) {
  const int trials = 1000;
  int bound = 0, notFinite = 0;
  const Points corners = test::randomPoints(3 * trials, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 9);
  for (int trial = 0; trial < trials; ++trial) {
    // The fourth corner lies in the plane of the others, and the vertex lies at the fourth corner.
    const Eigen::Vector3d &a = corners[3 * trial], &b = corners[3 * trial + 1], &c = corners[3 * trial + 2];
    const Eigen::Vector3d d = 0.3 * a + 0.5 * b + 0.2 * c;
    make(test::singleTet());
    body->m_nodes[0].m_x = toBullet(a);
    body->m_nodes[1].m_x = toBullet(b);
    body->m_nodes[2].m_x = toBullet(c);
    body->m_nodes[3].m_x = toBullet(d);
    test::setRenderNodes(*body, {test::inBulletsPrecision(d)});
    btSoftBodyHelpers::interpolateBarycentricWeights(body.get());
    if (body->m_renderNodesParents[0].size() == 0) continue;
    ++bound;
    const btVector4 w = body->m_renderNodesInterpolationWeights[0];
    notFinite += !std::isfinite(w[0]) || !std::isfinite(w[1]) || !std::isfinite(w[2]) || !std::isfinite(w[3]);
    if (!skin.bind(*body, meshOf({d})).ok()) continue;  // refused because it is flat
    vertices = {d};
    ASSERT_EQ(skin.update(), StatusCode::Ok);
    EXPECT_LT((ours(0) - d).norm(), 1e-5);
  }
  figure("flat tets taken, of 1,000", bound);
  figure("of these, with weights that are not finite", notFinite);
  EXPECT_GT(bound, 0);
  EXPECT_GT(notFinite, 0);
}

/// Bullet computes the four weights as independent quotients: on slivers, their error grows with the distance to the
/// world's origin.
TEST_F(BulletsBinding, HasWeightsThatDoNotSumToOne) {
  const int trials = 1000;
  const btVector3 away(1000, 0, 0);
  const Points corners = test::randomPoints(3 * trials, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 9);
  double bulletsSum = 0.0, oursSum = 0.0, bulletsError = 0.0, oursError = 0.0;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::Vector3d &a = corners[3 * trial], &b = corners[3 * trial + 1], &c = corners[3 * trial + 2];
    TetMesh sliver = test::singleTet();
    sliver.nodes = {a, b, c, (a + b + c) / 3.0 + kThickness * (b - a).cross(c - a)};
    if (isFlat(cornersOf(sliver, sliver.tets[0]))) continue;
    make(sliver);
    bindBoth({0.3 * a + 0.3 * b + 0.2 * c + 0.2 * sliver.nodes[3]});
    bulletsSum = std::max(bulletsSum, std::abs(bulletsWeightSum(0) - 1.0));
    const auto w = skin.binding()->embedding().bindings()[0].weights;
    oursSum = std::max(oursSum, std::abs(static_cast<double>(w[0] + w[1] + w[2] + w[3]) - 1.0));
    body->translate(away);
    updateBoth();
    bulletsError = std::max(bulletsError, (bullets(0) - vertices[0] - toEigen(away)).norm());
    oursError = std::max(oursError, (ours(0) - vertices[0] - toEigen(away)).norm());
  }
  figure("Bullet: largest difference of a sum of weights from 1, in 1,000 slivers", bulletsSum);
  figure("ours", oursSum);
  figure("Bullet: largest error 1,000 units from the origin", bulletsError);
  figure("ours", oursError);
  EXPECT_LE(oursSum, 3e-7);
  EXPECT_LT(oursError, kDouble ? 1e-6 : 3e-4);
  EXPECT_GT(bulletsError, (kDouble ? 0.0 : 30.0) * oursError);
}

/// The least negative weight is a distance divided by an altitude: a big tet far away wins over a thin one nearby.
TEST_F(BulletsBinding, TakesABigInnerTetInsteadOfTheThinLayerBelowTheVertex) {
  make(test::thinLayerCage(0.02));
  const Box3 box = boundingBox(cage.nodes);
  Points above = test::randomPoints(400, {Eigen::Vector3d(0.1, 0.0, 0.1), Eigen::Vector3d(0.9, 0.0, 0.9)}, 6);
  for (Eigen::Vector3d& p : above) p.y() = box.max().y() + 0.05;
  bindBoth(above);
  const auto inTheLayer = [&](int tet) {
    const TetCorners p = cornersOf(cage, cage.tets[tet]);
    return std::min({p[0].y(), p[1].y(), p[2].y(), p[3].y()}) > box.max().y() - 0.021;
  };
  const auto bindings = skin.binding()->embedding().bindings();
  int bulletsInLayer = 0, oursInLayer = 0;
  for (int v = 0; v < count(); ++v) {
    bulletsInLayer += inTheLayer(bulletsTet(v));
    oursInLayer += inTheLayer(bindings[v].tet);
  }
  figure("Bullet: vertices bound to the layer below them, of 400", bulletsInLayer);
  figure("ours", oursInLayer);
  EXPECT_EQ(oursInLayer, 400);
  EXPECT_LT(bulletsInLayer, 40);
}

/// Bullet binds to the nodes' current positions; a mesh at rest then gets the weights of a different position.
TEST_F(BulletsBinding, BindsAtTheCurrentShapeWhateverTheMeshWasMadeFor) {
  make(test::latticeCage(4, 4, 4, 0.25));
  const Points rest = test::randomPoints(500, boundingBox(cage.nodes), 8);
  const TetMesh restCage = cage;
  body->translate(btVector3(btScalar(0.4), 0, 0));  // the body has fallen a little before it is bound
  test::setRenderNodes(*body, rest);
  btSoftBodyHelpers::interpolateBarycentricWeights(body.get());
  ASSERT_TRUE(skin.bind(*body, restCage, meshOf(rest)).ok());
  vertices = rest;
  updateBoth();
  double bulletsError = 0.0, oursError = 0.0;
  for (int v = 0; v < count(); ++v) {
    const Eigen::Vector3d expected = rest[v] + Eigen::Vector3d(0.4, 0, 0);
    bulletsError = std::max(bulletsError, (bullets(v) - expected).norm());
    oursError = std::max(oursError, (ours(v) - expected).norm());
  }
  figure("Bullet: error of a mesh bound after the body has moved by 0.4", bulletsError);
  figure("ours", oursError);
  EXPECT_NEAR(bulletsError, 0.4, 1e-3);
  EXPECT_LT(oursError, 1e-5);
}

/// Render nodes bound to faces.
class BulletsFaces : public BulletsBinding {
 protected:
  /// A hollow ball: nodes and faces of a sphere; this library binds to a cage of its own.
  void makeBall(int rings) {
    const TriangleMesh ball = test::sphere(rings, 1.0, Eigen::Vector3d::Zero());
    std::vector<btVector3> nodes;
    for (const Eigen::Vector3d& p : ball.positions) nodes.push_back(toBullet(p));
    body = std::make_unique<btSoftBody>(&info, static_cast<int>(nodes.size()), nodes.data(), nullptr);
    for (const auto& t : ball.triangles) {
      if ((ball.positions[t[1]] - ball.positions[t[0]]).cross(ball.positions[t[2]] - ball.positions[t[0]]).norm() >
          1e-9) {
        body->appendFace(t[0], t[1], t[2]);
      }
    }
  }
};

/// Where Bullet has not yet found a face above which a vertex lies, it takes any face, however far away: on a convex
/// body, one on the opposite side.
TEST_F(BulletsFaces, AreOnTheFarSideForSomeVertices) {
  makeBall(12);
  Points above = test::randomPoints(4000, {Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)}, 7);
  for (Eigen::Vector3d& p : above) p *= 1.02 / p.norm();
  test::setRenderNodes(*body, above);
  btSoftBodyHelpers::extrapolateBarycentricWeights(body.get());
  int farSide = 0;
  for (int v = 0; v < static_cast<int>(above.size()); ++v) {
    const auto& parents = body->m_renderNodesParents[v];
    farSide += toEigen(parents[0]->m_x + parents[1]->m_x + parents[2]->m_x).dot(above[v]) < 0.0;
  }
  figure("vertices 2 % outside a ball bound to its far side, of 4,000", farSide);
  EXPECT_GT(farSide, 0);

  const TetMesh lattice = test::latticeCage(8, 8, 8, 0.25);  // for this library: a cage of the ball's size
  make({test::scaledAndMoved(lattice.nodes, 1.0, Eigen::Vector3d::Constant(-1.0)), lattice.tets});
  ASSERT_TRUE(skin.bind(*body, cage, meshOf(above)).ok());
  const auto bindings = skin.binding()->embedding().bindings();
  for (std::size_t v = 0; v < above.size(); ++v) {
    const TetCorners p = cornersOf(cage, cage.tets[bindings[v].tet]);
    EXPECT_GT((p[0] + p[1] + p[2] + p[3]).dot(above[v]), 0.0);
  }
}

/// The offset from a face is a separate length that `scale` does not change.
TEST_F(BulletsFaces, KeepTheirOffsetsWhenTheBodyIsScaled) {
  const btVector3 nodes[] = {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0)};
  const Eigen::Vector3d vertex(0.25, 0.25, 0.5);
  body = std::make_unique<btSoftBody>(&info, 3, nodes, nullptr);
  body->appendFace(0, 1, 2);
  test::setRenderNodes(*body, {vertex});
  btSoftBodyHelpers::extrapolateBarycentricWeights(body.get());
  body->scale(btVector3(2, 2, 2));
  body->interpolateRenderMesh();
  const double bulletsHeight = bullets(0).z();
  make(test::singleTet());
  bindBoth({vertex});
  body->scale(btVector3(2, 2, 2));
  updateBoth();
  figure("Bullet: height of a vertex 0.5 above a face, after scaling by 2", bulletsHeight);
  figure("ours", ours(0).z());
  EXPECT_NEAR(bulletsHeight, 0.5, 1e-5);
  EXPECT_NEAR(ours(0).z(), 1.0, 1e-5);
}

/// Each face has a normal and an offset of its own: the surface comes apart at the faces' edges when they bend.
TEST_F(BulletsFaces, TearTheSurfaceAtTheirEdgesWhenBent) {
  const btVector3 nodes[] = {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(1, 1, 0), btVector3(0, 1, 0)};
  body = std::make_unique<btSoftBody>(&info, 4, nodes, nullptr);
  body->appendFace(0, 1, 2);
  body->appendFace(0, 2, 3);
  test::setRenderNodes(*body, {{0.5005, 0.4995, 0.3}, {0.4995, 0.5005, 0.3}});  // on either side of the edge
  btSoftBodyHelpers::extrapolateBarycentricWeights(body.get());
  body->m_nodes[3].m_x = btVector3(btScalar(0.3), btScalar(0.7), btScalar(0.6));  // folded about the edge
  body->interpolateRenderMesh();
  const double gap = (bullets(0) - bullets(1)).norm();
  figure("gap between vertices 0.0014 apart, of a face bent about their edge", gap);
  EXPECT_GT(gap, 0.1);

  // This library binds to a cage of two tets per side that share the edge's plane, folded in the same way.
  make(test::latticeCage(2, 2, 1, 0.5));
  bindBoth({{0.5005, 0.4995, 0.8}, {0.4995, 0.5005, 0.8}});
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    btVector3& p = body->m_nodes[n].m_x;
    if (p.y() > p.x()) p.setZ(p.z() + (p.y() - p.x()));
  }
  updateBoth();
  figure("ours", (ours(0) - ours(1)).norm());
  EXPECT_LT((ours(0) - ours(1)).norm(), 0.01);
}

}  // namespace
}  // namespace tetskin
