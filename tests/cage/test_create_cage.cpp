// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Properties of the builder as a whole: fitting, the report, and bad and extreme input.
#include "cage_checks.h"
#include "cage_models.h"
#include "copy_checks.h"
#include "support/brute_force.h"
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/cage/create_cage.h>
#include <tetskin/core/embedding.h>

#include <limits>

namespace tetskin::test {
namespace {

Status failure(const TriangleMesh& mesh, std::size_t target = 3000) {
  CageOptions options;
  options.targetTets = target;
  const Result<Cage> result = createCage(mesh, options);
  EXPECT_EQ(result.ok(), result.status().message.empty());
  return result.status();
}

/// Points spread over the triangles, regardless of the triangles' sizes.
std::vector<Eigen::Vector3d> surfacePoints(const TriangleMesh& mesh, std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[i % mesh.triangleCount()];
    const double a = std::sqrt(uniform(random)), b = uniform(random) * a;
    points.push_back((1 - a) * mesh.positions[t[0]] + (a - b) * mesh.positions[t[1]] + b * mesh.positions[t[2]]);
  }
  return points;
}

EmbedReport embedded(const TetMesh& cage, const std::vector<Eigen::Vector3d>& points) {
  Embedding embedding;
  return embedInto(cage, viewOf(points), {}, embedding);
}

TEST(CageFit, SavesVolume) {
  for (const TriangleMesh& mesh : {figurineMesh(60), unitSphere(40), torusMesh(60), finnedSphereMesh()}) {
    const Built built = build(mesh);
    EXPECT_LT(built.report.cageVolume, 0.85 * built.report.cageVolumeUnfitted) << built.report.describe();
    EXPECT_GT(built.report.volumeRatio, 1.0);
  }
}

TEST(CageFit, WithoutItTheTetsAreTheLattices) {
  const Built built = build(figurineMesh(30), 3000, false);
  EXPECT_NEAR(built.report.minDihedralDegrees, 60.0, 1e-6);
  EXPECT_NEAR(built.report.maxDihedralDegrees, 90.0, 1e-6);
  EXPECT_DOUBLE_EQ(built.report.cageVolume, built.report.cageVolumeUnfitted);
}

TEST(CageFit, LeavesTheNumberOfTetsAlone) {
  const TriangleMesh mesh = figurineMesh(30);
  EXPECT_EQ(build(mesh, 1000, true).cage.mesh.tets, build(mesh, 1000, false).cage.mesh.tets);
}

TEST(CageFit, UnfittedCagesHoldAllOfEveryTriangle) {
  for (const TriangleMesh& mesh : {boxMesh({1, 2, 3}), finnedSphereMesh(), sheetMesh(1), torusMesh(12)}) {
    const Built built = build(mesh, 1000, false);
    EXPECT_EQ(embedded(built.cage.mesh, surfacePoints(mesh, 20000)).outside, 0u);
  }
}

TEST(CageFit, LargeTrianglesAreNotCutThrough) {
  for (const TriangleMesh& mesh : {boxMesh({1, 1, 1}), boxMesh({1, 1, 0.01}), finnedSphereMesh(), figurineMesh(10)}) {
    const Built built = build(mesh, 1000);
    const EmbedReport report = embedded(built.cage.mesh, surfacePoints(mesh, 20000));
    EXPECT_LT(report.maxDistance, 0.1 * built.report.spacing);
    EXPECT_LT(report.outside, 20000 / 20);
  }
}

TEST(CageFit, HoldsVerticesRoundedToFloat) {
  const TriangleMesh mesh = figurineMesh(40);
  std::vector<Eigen::Vector3f> rounded;
  for (const Eigen::Vector3d& p : mesh.positions) rounded.push_back(p.cast<float>());
  for (const bool fit : {true, false}) {
    TetMesh cage = build(mesh, 3000, fit).cage.mesh;
    for (Eigen::Vector3d& p : cage.nodes) p = p.cast<float>().cast<double>();
    Embedding embedding;
    EXPECT_LE(embedInto(cage, viewOf(rounded), {}, embedding).maxDistance, 1e-6);
  }
}

TEST(CageBuilder, SameInputSameCage) {
  const TriangleMesh mesh = figurineMesh(20);
  const Built a = build(mesh), b = build(mesh);
  EXPECT_TRUE(sameCage(a.cage, b.cage));
}

TEST(CageBuilder, AllVerticesInsideByBruteForce) {
  const TriangleMesh mesh = figurineMesh(16);
  for (const BruteHit& hit : bruteForce(build(mesh, 1000).cage.mesh, mesh.positions, OutsideRule::Nearest)) {
    EXPECT_TRUE(hit.inside);
    EXPECT_LE(hit.barycentric, 0.0);
  }
}

TEST(CageBuilder, ReportsComponents) {
  const TriangleMesh apart = joined(unitSphere(16), sphere(16, 1.0, {4, 0, 0}));
  EXPECT_EQ(build(apart).report.meshComponents, 2u);
  EXPECT_EQ(build(apart).report.components, 2u);
  const TriangleMesh near = joined(unitSphere(16), sphere(16, 1.0, {2.01, 0, 0}));
  const Built fused = build(near);
  EXPECT_EQ(fused.report.meshComponents, 2u);
  EXPECT_EQ(fused.report.components, 1u);
  EXPECT_NE(fused.report.describe().find("fused"), std::string::npos);
}

TEST(CageBuilder, ReportsVolumes) {
  const Built built = build(boxMesh({1, 2, 3}), 10000);
  EXPECT_DOUBLE_EQ(built.report.meshVolume, 6.0);
  EXPECT_GT(built.report.volumeRatio, 1.0);
  EXPECT_LT(built.report.volumeRatio, 1.2);
  EXPECT_EQ(built.report.openEdges, 0u);
  const Built sheet = build(sheetMesh(10), 1000);
  EXPECT_EQ(sheet.report.meshVolume, 0.0);
  EXPECT_EQ(sheet.report.volumeRatio, 0.0);
  EXPECT_EQ(sheet.report.openEdges, 40u);
}

TEST(CageBuilder, WorksWithoutOptionsAndReport) {
  const TetMesh cage = createCage(unitSphere(10)).value().mesh;
  EXPECT_NEAR(static_cast<double>(cage.tetCount()), 3000.0, 300.0);
}

TEST(CageBuilder, LooseVerticesShapeNoCage) {
  const TriangleMesh sphere = unitSphere(16);
  TriangleMesh mesh = sphere;
  for (const double far : {0.5, 1.2, 3.0, 1e4, 1e12}) {
    mesh.positions.emplace_back(far, 0, 0);
    mesh.positions.emplace_back(0, -far, 0.1);
  }
  for (const std::size_t target : {300, 3000}) {
    const Built built = build(mesh, target), without = build(sphere, target);
    ASSERT_TRUE(built.status.ok());
    EXPECT_EQ(faultOfCage(mesh, built.cage, built.report), "");
    EXPECT_EQ(built.cage.mesh.nodes, without.cage.mesh.nodes);
    EXPECT_EQ(built.cage.mesh.tets, without.cage.mesh.tets);
    EXPECT_EQ(built.report.looseVertices, 10u);
    EXPECT_EQ(built.report.components, 1u);
    EXPECT_EQ(built.report.fusedComponents, 0u);
    EXPECT_NE(built.report.describe().find("10 vertices shape no cage"), std::string::npos);
    EXPECT_EQ(without.report.describe().find("shape no cage"), std::string::npos);
  }
}

TEST(CageBuilder, TheNearestTetCarriesALooseVertex) {
  TriangleMesh mesh = unitSphere(16);
  const std::size_t used = mesh.vertexCount();
  for (const Eigen::Vector3d& p :
       randomPoints(100, Box3(Eigen::Vector3d::Constant(-3), Eigen::Vector3d::Constant(3)), 5))
    mesh.positions.push_back(p);
  const Built built = build(mesh, 300);
  ASSERT_TRUE(built.status.ok());
  const std::vector<BruteHit> wanted = bruteForce(built.cage.mesh, mesh.positions, OutsideRule::Nearest);
  EmbedReport report;
  const Embedding embedding = embed(built.cage, mesh, {}, &report).value();
  std::size_t outside = 0;
  for (std::size_t v = used; v < mesh.vertexCount(); ++v) {
    EXPECT_EQ(built.cage.vertexTets[v], wanted[v].tet) << v;
    EXPECT_EQ(embedding.at(v).inside, wanted[v].inside) << v;
    outside += wanted[v].inside ? 0 : 1;
    const auto at = embedding.at(v).position([&](int n) { return built.cage.mesh.nodes[static_cast<std::size_t>(n)]; });
    EXPECT_LT((at - mesh.positions[v]).norm(), 1e-5);
  }
  EXPECT_EQ(report.outside, outside);
  EXPECT_GT(outside, 50u);
  EXPECT_EQ(report.maxDistance, 0.0) << "of vertices that triangles use";
  EXPECT_LT(report.meshBox.max().maxCoeff(), 1.0 + 1e-9);
  EXPECT_FALSE(report.unitsDiffer());
}

TEST(CageBuilder, TrianglesThatArePointsAreNone) {
  TriangleMesh mesh = unitSphere(16);
  mesh.positions.emplace_back(3, 0, 0);
  const int last = static_cast<int>(mesh.vertexCount()) - 1;
  mesh.triangles.push_back({last, last, last});
  const Built built = build(mesh, 300);
  ASSERT_TRUE(built.status.ok());
  EXPECT_EQ(built.report.components, 1u);
  EXPECT_EQ(built.report.looseVertices, 1u);
  mesh.triangles = {{0, 0, 0}, {last, last, last}};
  EXPECT_EQ(failure(mesh).code, StatusCode::Degenerate);
}

TEST(CageBuilder, TinyTargetsAreMetAsWellAsPossible) {
  for (std::size_t target = 1; target <= 60; ++target) {
    const TriangleMesh mesh = boxMesh({1, 1, 1});
    const Built built = build(mesh, target);
    EXPECT_EQ(faultOfCage(mesh, built.cage, built.report), "");
    EXPECT_NEAR(static_cast<double>(built.report.tets), static_cast<double>(target), 2.0 + 0.1 * target);
    const bool said = built.report.describe().find("were requested") != std::string::npos;
    EXPECT_EQ(said, !built.report.targetMet());
  }
}

TEST(CageInput, EmptyMeshes) {
  EXPECT_EQ(failure({}).code, StatusCode::Empty);
  TriangleMesh cloud;
  cloud.positions = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(failure(cloud).code, StatusCode::Empty);
  EXPECT_NE(failure(cloud).message.find("no triangles"), std::string::npos);
}

TEST(CageInput, CoordinatesThatAreNoNumbers) {
  TriangleMesh mesh = unitSphere(8);
  mesh.positions[17].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(failure(mesh).code, StatusCode::NonFinite);
  EXPECT_NE(failure(mesh).message.find("vertex 17"), std::string::npos);
  mesh.positions[17].y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(failure(mesh).code, StatusCode::NonFinite);
}

TEST(CageInput, IndicesOutOfRange) {
  TriangleMesh mesh = unitSphere(8);
  mesh.triangles[5] = {0, 1, 100000};
  EXPECT_EQ(failure(mesh).code, StatusCode::IndexOutOfRange);
  mesh.triangles[5] = {0, -1, 1};
  EXPECT_EQ(failure(mesh).code, StatusCode::IndexOutOfRange);
}

TEST(CageInput, TargetsThatMakeNoSense) {
  EXPECT_EQ(failure(unitSphere(8), 0).code, StatusCode::InvalidOption);
  const Status tooMany = failure(unitSphere(8), Limits::kMaxTargetTets + 1);
  EXPECT_EQ(tooMany.code, StatusCode::InvalidOption);
  EXPECT_NE(tooMany.message.find(std::to_string(Limits::kMaxTargetTets)), std::string::npos);
  EXPECT_EQ(failure(unitSphere(8), std::numeric_limits<std::size_t>::max()).code, StatusCode::InvalidOption);
}

TEST(CageInput, NoExtent) {
  TriangleMesh mesh;
  mesh.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(failure(mesh).code, StatusCode::Degenerate);
}

TEST(CageInput, ExtentThatDoubleCannotDivide) {
  EXPECT_EQ(failure(transformed(unitSphere(8), 1e-6, {1e6, 0, 0})).code, StatusCode::Degenerate);
  EXPECT_EQ(failure(transformed(unitSphere(8), 1e100, Eigen::Vector3d::Zero())).code, StatusCode::Degenerate);
  EXPECT_EQ(failure(transformed(unitSphere(8), 1e-100, Eigen::Vector3d::Zero())).code, StatusCode::Degenerate);
}

TEST(CageInput, ARefusedMeshHasAReportOfWhatWasKnown) {
  const Built built = build({}, 77);
  EXPECT_FALSE(built.status.ok());
  EXPECT_TRUE(built.cage.mesh.tets.empty());
  EXPECT_EQ(built.report.targetTets, 77u);
  EXPECT_EQ(built.report.tets, 0u);
}

TEST(CageProgress, AscendsToTheEndAndChangesNothing) {
  const TriangleMesh mesh = unitSphere(16);
  std::vector<double> told;
  CageOptions options;
  options.targetTets = 300;
  const Cage silent = createCage(mesh, options).value();
  options.progress = [&](double fraction) { return told.push_back(fraction), true; };
  const Cage cage = createCage(mesh, options).value();
  EXPECT_EQ(cage.mesh.nodes, silent.mesh.nodes);
  EXPECT_EQ(cage.mesh.tets, silent.mesh.tets);
  EXPECT_GT(told.size(), 3u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_EQ(told.back(), 1.0);
}

TEST(CageProgress, CancelsAtEachCallAndIsNotCalledAgain) {
  const TriangleMesh mesh = unitSphere(16);
  CageOptions options;
  options.targetTets = 300;
  int calls = 0, last = 100;
  options.progress = [&](double) { return ++calls <= last; };
  ASSERT_TRUE(createCage(mesh, options).ok());
  const int all = calls;
  for (last = 0; last < all; ++last) {
    calls = 0;
    const Result<Cage> cage = createCage(mesh, options);
    EXPECT_EQ(cage.status().code, StatusCode::Cancelled);
    EXPECT_NE(cage.status().message.find("createCage was cancelled"), std::string::npos);
    EXPECT_EQ(calls, last + 1);
  }
}

}  // namespace
}  // namespace tetskin::test
