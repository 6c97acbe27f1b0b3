// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <tetskin/contact/src/rigid/surface_patches.h>

namespace tetskin::test {

using namespace bullet_detail;
using namespace contact_detail;

namespace {

/// The positions of the contact points at rest.
std::vector<Eigen::Vector3d> pointsOf(const ContactPatches& patches, const ContactPatch& patch, const TetMesh& cage) {
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t p = 0; p < patch.numberCount(); ++p) {
    const std::uint32_t i = p / (patch.divisions + 1), j = p % (patch.divisions + 1);
    if (patch.isTriangle() && (i + j > patch.divisions || std::max(i, j) == patch.divisions || i + j == 0)) continue;
    std::array<btScalar, kMaxCarriers> weights{};
    patches.weightsOf(patch, p, weights.data());
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      at += static_cast<double>(weights[n]) * cage.nodes[static_cast<std::size_t>(patches.nodes[patch.firstNode + n])];
    }
    points.push_back(at);
  }
  EXPECT_EQ(points.size(), patch.pointCount);
  return points;
}

std::vector<Eigen::Vector3d> pointsOf(const ContactPatches& patches, const TetMesh& cage) {
  std::vector<Eigen::Vector3d> points;
  for (const ContactPatch& patch : patches.patches) {
    const auto more = pointsOf(patches, patch, cage);
    points.insert(points.end(), more.begin(), more.end());
  }
  EXPECT_EQ(points.size(), patches.pointCount);
  return points;
}

double farthestFromAny(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double farthest = 0.0;
  for (const Eigen::Vector3d& p : from) {
    double minimum = HUGE_VAL;
    for (const Eigen::Vector3d& q : to) minimum = std::min(minimum, (p - q).norm());
    farthest = std::max(farthest, minimum);
  }
  return farthest;
}

TEST(ContactPatches, HaveEachPlaceOfTheMeshOnce) {
  const TetMesh cage = looseCage();
  TriangleMesh mesh = ballMesh(10, 0.4);
  const std::size_t indices = mesh.vertexCount();
  const std::vector<Eigen::Vector3d> seam(mesh.positions.begin(), mesh.positions.begin() + 50);
  mesh.positions.insert(mesh.positions.end(), seam.begin(), seam.end());  // duplicates, as on the two sides of a seam
  const ContactPatches patches = makeContactPatches(embed(cage, mesh).value(), mesh, {});
  EXPECT_EQ(patches.pointCount, indices);
  const auto points = pointsOf(patches, cage);
  EXPECT_LT(farthestFromAny(mesh.positions, points), 1e-6);
  EXPECT_LT(farthestFromAny(points, mesh.positions), 1e-6);
}

TEST(ContactPatches, HaveNoVerticesThatNoTriangleUses) {
  const TetMesh cage = looseCage();
  TriangleMesh mesh = ballMesh(10, 0.4);
  const std::vector<Eigen::Vector3d> used = mesh.positions;
  for (int k = 0; k < 30; ++k) mesh.positions.emplace_back(0.1 * k, 0.01 * k, 0.0);
  const ContactPatches patches = makeContactPatches(embed(cage, mesh).value(), mesh, {});
  EXPECT_LT(farthestFromAny(pointsOf(patches, cage), used), 1e-6);
  EXPECT_EQ(patches.pointCount, used.size());
  mesh.triangles.clear();  // a cloud: all points count
  EXPECT_EQ(makeContactPatches(embed(cage, mesh).value(), mesh, {}).pointCount, mesh.vertexCount());
}

TEST(ContactPatches, SampleTrianglesNoFartherApartThanTheSpacing) {
  const TetMesh cage = looseCage();
  const TriangleMesh mesh = boxMesh(Eigen::Vector3d(0.4, 0.3, 0.35));
  const ContactPatches patches = makeContactPatches(embed(cage, mesh).value(), mesh, divisionsFor(mesh, 0.05));
  const auto points = pointsOf(patches, cage);
  std::vector<Eigen::Vector3d> onSides;
  for (double u = -0.4; u <= 0.4; u += 0.04) {
    for (double v = -0.35; v <= 0.35; v += 0.035) onSides.emplace_back(u, 0.3, v);
  }
  EXPECT_LT(farthestFromAny(onSides, points), 0.05);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d beyond = p.cwiseAbs() - Eigen::Vector3d(0.4, 0.3, 0.35);
    EXPECT_NEAR(beyond.maxCoeff(), 0.0, 1e-6);  // the points are on the surface
  }
}

/// The cage's own surface: vertices are nodes, and the samples between them are carried by the three corners.
TEST(ContactPatches, KnowTheNodesAloneThatCarryTheirPoints) {
  const TetMesh cage = latticeCage(2, 2, 2, 0.5);
  TriangleMesh mesh;
  mesh.positions = cage.nodes;
  mesh.triangles = boundaryFaces(cage);
  const ContactPatches patches = makeContactPatches(embed(cage, mesh).value(), mesh, divisionsFor(mesh, 0.1));
  for (const ContactPatch& patch : patches.patches) {
    EXPECT_LE(patch.nodeCount, patch.isTriangle() ? 3u : patch.pointCount);
  }
  EXPECT_GT(patches.pointCount, 500u);
}

TEST(ContactPatches, KeepWithinTheirSpread) {
  const TetMesh cage = looseCage();
  const TriangleMesh mesh = ballMesh(10, 0.6);
  const ContactPatches patches = makeContactPatches(embed(cage, mesh).value(), mesh, divisionsFor(mesh, 0.1));
  const auto points = pointsOf(patches, cage);
  std::size_t at = 0, inClusters = 0;
  for (const ContactPatch& patch : patches.patches) {
    Box3 box;
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      box.extend(cage.nodes[static_cast<std::size_t>(patches.nodes[patch.firstNode + n])]);
    }
    for (std::uint32_t p = 0; p < patch.pointCount; ++p, ++at) {
      const Eigen::Vector3d from = (points[at] - box.center()).cwiseAbs();
      EXPECT_LE((from - static_cast<double>(patch.spread) * box.sizes() / 2).maxCoeff(), 1e-6);
    }
  }
  for (const PatchCluster& cluster : patches.clusters) inClusters += cluster.patchCount;
  EXPECT_EQ(inClusters, patches.patches.size());
}

}  // namespace
}  // namespace tetskin::test
