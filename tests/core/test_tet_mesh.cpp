// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>
#include <map>
#include <set>

namespace tetskin {
namespace {

double signedTotal(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Tet& t : mesh.tets) sum += signedVolume(cornersOf(mesh, t));
  return sum;
}

TEST(TetMesh, LatticeIsClean) {
  const TetMesh mesh = test::latticeCage(3, 4, 5, 0.5);
  const TetMeshReport report = checkTetMesh(mesh);
  EXPECT_TRUE(report.clean()) << report.describe();
  EXPECT_TRUE(report.describe().empty());
  EXPECT_TRUE(validate(mesh, report).ok());
  EXPECT_NEAR(signedTotal(mesh), 3 * 4 * 5 * 0.125, 1e-12);
  EXPECT_NEAR(totalVolume(mesh), 3 * 4 * 5 * 0.125, 1e-12);
}

TEST(TetMesh, CountsAndPlacesEveryFault) {
  TetMesh mesh = test::latticeCage(1, 1, 1);
  mesh.nodes.emplace_back(9, 9, 9);        // 8: unreferenced
  mesh.nodes.emplace_back(0.5, 0.5, 0.5);  // 9
  mesh.tets.push_back({0, 1, 3, 99});      // 6: out of range
  mesh.tets.push_back({0, -1, 3, 2});      // 7: out of range
  mesh.tets.push_back({0, 1, 1, 9});       // 8: repeated node
  mesh.tets.push_back({0, 1, 2, 3});       // 9: flat
  mesh.tets.push_back({0, 2, 1, 9});       // 10: reversed
  mesh.tets.push_back({9, 1, 2, 0});       // 11: duplicate of 10
  const TetMeshReport report = checkTetMesh(mesh);
  EXPECT_EQ(report.indexOutOfRange.count, 2u);
  EXPECT_EQ(report.indexOutOfRange.first, 6u);
  EXPECT_EQ(report.repeatedNode.count, 1u);
  EXPECT_EQ(report.repeatedNode.first, 8u);
  EXPECT_EQ(report.zeroVolume.count, 1u);
  EXPECT_EQ(report.zeroVolume.first, 9u);
  EXPECT_EQ(report.negativeVolume.count, 2u);
  EXPECT_EQ(report.negativeVolume.first, 10u);
  EXPECT_EQ(report.duplicateTets.count, 1u);
  EXPECT_EQ(report.duplicateTets.first, 11u);
  EXPECT_EQ(report.unreferencedNodes.count, 1u);
  EXPECT_EQ(report.unreferencedNodes.first, 8u);
  EXPECT_FALSE(report.clean());
  const std::string text = report.describe();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6);
}

TEST(TetMesh, ReportsNonFiniteNodes) {
  TetMesh mesh = test::singleTet();
  mesh.nodes[2].y() = std::numeric_limits<double>::quiet_NaN();
  const TetMeshReport report = checkTetMesh(mesh);
  EXPECT_EQ(report.nonFiniteNodes.count, 1u);
  EXPECT_EQ(report.nonFiniteNodes.first, 2u);
  EXPECT_EQ(validate(mesh, report).code, StatusCode::NonFinite);
}

TEST(TetMesh, RefusesMoreTetsThanItsIndicesCanNumber) {
  EXPECT_TRUE(checkTetCounts(Limits::kMaxTets, Limits::kMaxTets).ok());
  const Status nodes = checkTetCounts(Limits::kMaxTets + 1, 1);
  EXPECT_EQ(nodes.code, StatusCode::TooLarge);
  EXPECT_NE(nodes.message.find("134217728 nodes"), std::string::npos) << nodes.message;
  const Status tets = checkTetCounts(4, Limits::kMaxTets + 1);
  EXPECT_EQ(tets.code, StatusCode::TooLarge);
  EXPECT_NE(tets.message.find("134217728 tets"), std::string::npos) << tets.message;
}

TEST(TetMesh, UsableRefusesWhatCannotBeEmbeddedIn) {
  TetMesh mesh;
  EXPECT_EQ(validate(mesh, checkTetMesh(mesh)).code, StatusCode::Empty);
  mesh = test::singleTet();
  mesh.tets[0][3] = 4;
  EXPECT_EQ(validate(mesh, checkTetMesh(mesh)).code, StatusCode::IndexOutOfRange);
  mesh = test::singleTet();
  mesh.nodes[3].z() = 0.0;
  const Status flat = validate(mesh, checkTetMesh(mesh));
  EXPECT_EQ(flat.code, StatusCode::Degenerate);
  EXPECT_NE(flat.message.find("flat; "), std::string::npos) << flat.message;
}

TEST(TetMesh, UsableAcceptsSurvivableFaults) {
  TetMesh mesh = test::latticeCage(1, 1, 1);
  mesh.tets.push_back({0, 1, 2, 3});
  mesh.nodes.emplace_back(1, 2, 3);
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  EXPECT_TRUE(validate(mesh, checkTetMesh(mesh)).ok());
}

TEST(TetMesh, CheckForUseDecidesAsTheFullCheckDoes) {
  std::vector<TetMesh> meshes(5, test::latticeCage(1, 1, 1));
  meshes[1].tets[2][1] = -1;
  meshes[2].nodes[1].x() = std::numeric_limits<double>::infinity();
  for (Tet& t : meshes[3].tets) t[3] = t[0];
  meshes[4].tets.push_back(meshes[4].tets[0]);
  for (const TetMesh& mesh : meshes) {
    const Status quick = validate(mesh, inspectForUse(mesh)), full = validate(mesh, checkTetMesh(mesh));
    EXPECT_EQ(quick.code, full.code);
    EXPECT_EQ(quick.message, full.message);
  }
  EXPECT_EQ(inspectForUse(meshes[4]).duplicateTets.count, 0u);
}

TEST(TetMesh, RepairReorientsNegativeTetsAndReportsThem) {
  TetMesh mesh = test::latticeCage(2, 2, 2);
  const double volume = signedTotal(mesh);
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);
  std::swap(mesh.tets[7][2], mesh.tets[7][3]);
  EXPECT_LT(signedTotal(mesh), volume - 0.1);
  const TetMeshReport report = repairTetMesh(mesh);
  EXPECT_EQ(report.negativeVolume.count, 2u);
  EXPECT_EQ(report.negativeVolume.first, 3u);
  EXPECT_NEAR(signedTotal(mesh), volume, 1e-12);
  EXPECT_TRUE(checkTetMesh(mesh).clean());
}

TEST(TetMesh, RepairLeavesAnUnusableMeshAlone) {
  TetMesh mesh = test::latticeCage(1, 1, 1);
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  mesh.tets[1][0] = -5;
  const std::vector<Tet> before = mesh.tets;
  EXPECT_EQ(repairTetMesh(mesh).indexOutOfRange.count, 1u);
  EXPECT_EQ(mesh.tets, before);
}

TEST(TetMesh, FlatnessDoesNotDependOnTheUnit) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    TetMesh mesh = test::singleTet();
    for (Eigen::Vector3d& p : mesh.nodes) p *= scale;
    EXPECT_EQ(checkTetMesh(mesh).zeroVolume.count, 0u) << scale;
    mesh.nodes[3].z() *= 1e-12;
    EXPECT_EQ(checkTetMesh(mesh).zeroVolume.count, 1u) << scale;
  }
}

TEST(TetMesh, EdgesAreDistinctAndInOrderOfFirstAppearance) {
  const TetMesh mesh = test::latticeCage(2, 1, 1);
  const auto edges = uniqueEdges(mesh);
  std::vector<std::array<int, 2>> expected;
  std::set<std::array<int, 2>> seen;
  for (const Tet& t : mesh.tets) {
    for (const auto& e :
         {std::array{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}, {t[0], t[3]}, {t[1], t[3]}, {t[2], t[3]}}) {
      if (seen.insert({std::min(e[0], e[1]), std::max(e[0], e[1])}).second) expected.push_back(e);
    }
  }
  EXPECT_EQ(edges, expected);
}

TEST(TetMesh, BoundaryOfALatticeIsClosedAndFacesOutwards) {
  const TetMesh mesh = test::latticeCage(3, 2, 4);
  const auto faces = boundaryFaces(mesh);
  EXPECT_EQ(faces.size(), 2u * 2u * (3 * 2 + 2 * 4 + 3 * 4));
  std::map<std::pair<int, int>, int> directed;
  double volume = 0.0;
  for (const auto& f : faces) {
    for (int k = 0; k < 3; ++k) ++directed[{f[k], f[(k + 1) % 3]}];
    volume += mesh.nodes[f[0]].cross(mesh.nodes[f[1]]).dot(mesh.nodes[f[2]]) / 6.0;
  }
  for (const auto& [edge, count] : directed) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ((directed.count({edge.second, edge.first})), 1u);
  }
  EXPECT_NEAR(volume, 3 * 2 * 4, 1e-12);  // by the divergence theorem: positive only if the faces look outwards
}

TEST(TetMesh, BoundaryOfOneTetIsItsFourFaces) {
  EXPECT_EQ(boundaryFaces(test::singleTet()).size(), 4u);
  EXPECT_EQ(uniqueEdges(test::singleTet()).size(), 6u);
}

TEST(TetMesh, EmptyMeshHasNoEdgesAndNoFaces) {
  EXPECT_TRUE(uniqueEdges({}).empty());
  EXPECT_TRUE(boundaryFaces({}).empty());
  EXPECT_TRUE(checkTetMesh({}).clean());
}

}  // namespace
}  // namespace tetskin
