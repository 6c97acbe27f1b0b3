// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How bindRenderNodes binds a body, compared with Bullet.
#include "bullets_render_mesh.h"

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>

namespace tetskin::test {
namespace {

constexpr bool kDouble = sizeof(btScalar) == 8;
/// Rounding of barycentric distances computed by Bullet.
constexpr double kBulletsRounding = kDouble ? 1e-9 : 1e-5;

/// The four parents of one render node, as node indices.
Tet parentsOf(const btSoftBody& body, int v) {
  Tet tet{-1, -1, -1, -1};
  const auto& parents = body.m_renderNodesParents[v];
  for (int k = 0; k < std::min(4, parents.size()); ++k) tet[k] = static_cast<int>(parents[k] - &body.m_nodes[0]);
  return tet;
}

double distanceIn(const btSoftBody& body, const Tet& tet, int v) {
  TetCorners corners;
  for (int k = 0; k < 4; ++k) corners[k] = toEigen(body.m_nodes[tet[k]].m_x);
  return barycentricDistance(BarycentricMap(corners)(toEigen(body.m_renderNodes[v].m_x)));
}

double largestWeight(const btVector4& w) {
  return static_cast<double>(std::max({btFabs(w[0]), btFabs(w[1]), btFabs(w[2]), btFabs(w[3]), btScalar(1)}));
}

class RenderNodes : public testing::Test {
 protected:
  void make(const TetMesh& cage, const std::vector<Eigen::Vector3d>& points) {
    for (std::unique_ptr<btSoftBody>* body : {&ours, &bullets}) {
      *body = createSoftBody(cage, info).value();
      ASSERT_TRUE(*body);
      setRenderNodes(**body, points);
    }
  }

  static void bend(btSoftBody& body) {
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      btVector3& p = body.m_nodes[n].m_x;
      p += btScalar(0.2) * btVector3(btSin(4 * p.y()), p.x() * p.z(), btCos(3 * p.x()));
    }
  }

  /// Binds both and compares tets and weights; then bends both and compares the points that Bullet's update computes.
  /// Returns how many render nodes have different tets.
  int compare() {
    const Result<EmbedReport> report = bindRenderNodes(*ours);
    EXPECT_TRUE(report.ok()) << report.status().message;
    btSoftBodyHelpers::interpolateBarycentricWeights(bullets.get());
    const int count = ours->m_renderNodes.size();
    EXPECT_EQ(static_cast<int>(report.value().vertexCount), count);
    EXPECT_EQ(ours->m_renderNodesParents.size(), count);
    EXPECT_EQ(ours->m_renderNodesInterpolationWeights.size(), count);
    EXPECT_EQ(ours->m_z.size(), 0);
    std::vector<char> same(count, 0);
    for (int v = 0; v < count; ++v) same[v] = compareBinding(v);
    bend(*ours);
    bend(*bullets);
    ours->interpolateRenderMesh();
    bullets->interpolateRenderMesh();
    for (int v = 0; v < count; ++v) {
      const double size = largestWeight(ours->m_renderNodesInterpolationWeights[v]);
      const double gap = static_cast<double>((ours->m_renderNodes[v].m_x - bullets->m_renderNodes[v].m_x).length());
      if (!same[v]) continue;
      EXPECT_LT(gap, (kDouble ? 1e-8 : 2e-5) * size) << "render node " << v;
    }
    return static_cast<int>(std::count(same.begin(), same.end(), 0));
  }

  bool compareBinding(int v) const {
    const Tet our = parentsOf(*ours, v), their = parentsOf(*bullets, v);
    EXPECT_GE(their[3], 0);
    const btVector4 w = ours->m_renderNodesInterpolationWeights[v];
    EXPECT_NEAR(static_cast<double>(w[0] + w[1] + w[2] + w[3]), 1.0, 1e-6 * largestWeight(w));
    if (our != their) {
      // Bullet decides in its own precision: it may choose differently where two tets are equally good.
      EXPECT_NEAR(distanceIn(*ours, our, v), distanceIn(*ours, their, v), kBulletsRounding * largestWeight(w));
      return false;
    }
    for (int k = 0; k < 4; ++k) {
      const btScalar bulletsWeight = bullets->m_renderNodesInterpolationWeights[v][k];
      EXPECT_NEAR(static_cast<double>(w[k]), static_cast<double>(bulletsWeight), kBulletsRounding * largestWeight(w));
    }
    return true;
  }

  btSoftBodyWorldInfo info;
  std::unique_ptr<btSoftBody> ours, bullets;
};

const Box3 kAround(Eigen::Vector3d::Constant(-0.15), Eigen::Vector3d::Constant(1.15));

TEST_F(RenderNodes, AgreeWithBulletOnALattice) {
  make(test::latticeCage(4, 4, 4, 0.25), test::randomPoints(3000, kAround, 3));
  // For points outside, the tets of a lattice are often equally good.
  EXPECT_LT(compare(), 1000);
}

TEST_F(RenderNodes, AgreeWithBulletOnIrregularCages) {
  for (const unsigned seed : {5u, 6u, 7u}) {
    TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
    const auto noise =
        test::randomPoints(cage.nodeCount(), {Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.06)}, seed);
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) cage.nodes[n] += noise[n];
    make(cage, test::randomPoints(2000, kAround, seed + 10));
    EXPECT_LE(compare(), kDouble ? 0 : 3);
  }
}

TEST_F(RenderNodes, AgreeWithBulletOnOverlappingTets) {
  TetMesh cage = test::randomTets(150, 0.5, 8);
  const auto thin = [&](const Tet& tet) {
    const TetCorners p = cornersOf(cage, tet);
    // Above this thickness, Bullet's float weights are accurate to 1e-5.
    return 6.0 * signedVolume(p) < 0.02 * std::pow(tetSize(p), 3.0);
  };
  cage.tets.erase(std::remove_if(cage.tets.begin(), cage.tets.end(), thin), cage.tets.end());
  make(cage, test::randomPoints(2000, kAround, 9));
  EXPECT_LE(compare(), kDouble ? 0 : 3);
}

TEST_F(RenderNodes, BindWhereTheNodesAreNow) {
  const std::vector<Eigen::Vector3d> points = test::randomPoints(500, kAround, 4);
  make(test::latticeCage(2, 2, 2, 0.5), points);
  ours->translate(btVector3(3, 0, 0));
  for (int v = 0; v < ours->m_renderNodes.size(); ++v) ours->m_renderNodes[v].m_x += btVector3(3, 0, 0);
  const Result<EmbedReport> report = bindRenderNodes(*ours);
  ASSERT_TRUE(report.ok()) << report.status().message;
  EXPECT_GT(report.value().inside, 200u);
  EXPECT_EQ(report.value().inside + report.value().outside, points.size());
  ours->translate(btVector3(0, 1, 0));
  ours->interpolateRenderMesh();
  for (int v = 0; v < ours->m_renderNodes.size(); ++v) {
    EXPECT_LT((toEigen(ours->m_renderNodes[v].m_x) - points[v] - Eigen::Vector3d(3, 1, 0)).norm(), 1e-5);
  }
}

TEST_F(RenderNodes, FarOnesFollowWhereBulletLosesThem) {
  make(test::latticeCage(2, 2, 2, 0.5), {{600.0, 0.3, 0.4}});
  btSoftBodyHelpers::interpolateBarycentricWeights(bullets.get());
  EXPECT_EQ(bullets->m_renderNodesParents[0].size(), 0);
  ASSERT_TRUE(bindRenderNodes(*ours).ok());
  ours->translate(btVector3(0, 2, 0));
  ours->interpolateRenderMesh();
  EXPECT_LT((toEigen(ours->m_renderNodes[0].m_x) - Eigen::Vector3d(600.0, 2.3, 0.4)).norm(), 1e-2);
}

TEST_F(RenderNodes, NeverBoundToAFlatTet) {
  make(test::singleTet(), test::randomPoints(200, kAround, 2));
  // Two tets are squeezed flat: one across the first tet, one at a corner of it.
  for (const btVector3& p : {btVector3(1, 1, 1), btVector3(0, 0, 1)}) ours->appendNode(p, 1);
  while (ours->m_tetras.size() > 0) ours->m_tetras.pop_back();  // the nodes may have moved in memory
  ours->appendTetra(4, 1, 2, 3);
  ours->appendTetra(0, 3, 5, 1);
  ours->appendTetra(0, 1, 2, 3);
  ours->m_nodes[4].m_x = (ours->m_nodes[1].m_x + ours->m_nodes[2].m_x) / btScalar(2);
  const Result<EmbedReport> report = bindRenderNodes(*ours);
  ASSERT_TRUE(report.ok()) << report.status().message;
  EXPECT_EQ(report.value().flatTets, 2u);
  for (int v = 0; v < ours->m_renderNodes.size(); ++v) EXPECT_EQ(parentsOf(*ours, v), (Tet{0, 1, 2, 3}));
}

TEST_F(RenderNodes, ReplaceABindingToFaces) {
  make(test::latticeCage(2, 2, 2, 0.5), test::randomPoints(100, kAround, 1));
  btSoftBodyHelpers::extrapolateBarycentricWeights(ours.get());
  ASSERT_EQ(ours->m_z.size(), 100);
  compare();
}

TEST_F(RenderNodes, FaultsLeaveTheBodyAsItWas) {
  const std::vector<Eigen::Vector3d> points = test::randomPoints(50, kAround, 1);
  make(test::latticeCage(2, 2, 2, 0.5), points);
  ASSERT_TRUE(bindRenderNodes(*ours).ok());
  const btVector4 weights = ours->m_renderNodesInterpolationWeights[7];
  const Tet parents = parentsOf(*ours, 7);
  ours->m_z.resize(50, btScalar(1));
  const auto fails = [&](StatusCode code, const char* mentions) {
    const Result<EmbedReport> report = bindRenderNodes(*ours);
    EXPECT_EQ(report.status().code, code);
    EXPECT_NE(report.status().message.find(mentions), std::string::npos) << report.status().message;
    EXPECT_EQ(ours->m_renderNodesParents.size(), 50);
    EXPECT_EQ(ours->m_renderNodesInterpolationWeights.size(), 50);
    EXPECT_EQ(ours->m_z.size(), 50);
    EXPECT_EQ(parentsOf(*ours, 7), parents);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(ours->m_renderNodesInterpolationWeights[7][k], weights[k]);
  };
  constexpr btScalar kNaN = std::numeric_limits<btScalar>::quiet_NaN();
  const btVector3 node = ours->m_nodes[3].m_x;
  ours->m_nodes[3].m_x.setY(kNaN);
  fails(StatusCode::NonFinite, "node 3");
  ours->m_nodes[3].m_x = node;
  ours->m_renderNodes[2].m_x.setZ(kNaN);
  fails(StatusCode::NonFinite, "vertex 2");
  setRenderNodes(*ours, points);
  while (ours->m_tetras.size() > 0) ours->m_tetras.pop_back();
  fails(StatusCode::Empty, "tet");
  setRenderNodes(*ours, {});
  fails(StatusCode::Empty, "render nodes");
}

TEST_F(RenderNodes, TetsLeftDanglingAreRefused) {
  make(test::latticeCage(1, 1, 1), test::randomPoints(10, kAround, 1));
  const btSoftBody::Node* const before = &ours->m_nodes[0];
  while (&ours->m_nodes[0] == before) ours->appendNode(btVector3(0, 0, 0), 1);  // until the array moves
  EXPECT_EQ(bindRenderNodes(*ours).status().code, StatusCode::IndexOutOfRange);
  EXPECT_EQ(ours->m_renderNodesParents.size(), 0);
}

}  // namespace
}  // namespace tetskin::test
