// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The report of an embedding, for good and bad input.
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>

#include <limits>

namespace tetskin {
namespace {

using Points = std::vector<Eigen::Vector3d>;

const Box3 kSampledBox(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());

TEST(EmbedReport, ReportNamesTheWorstVertex) {
  const TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  const Points vertices{{0.5, 0.5, 0.5}, {0.5, 1.5, 0.5}, {0.5, 0.5, -2.0}, {1.1, 0.5, 0.5}};
  const Fit report = embedInto(cage, viewOf(vertices));
  EXPECT_EQ(report.inside, 1u);
  EXPECT_EQ(report.outside, 3u);
  EXPECT_EQ(report.maxDistanceVertex, 2u);
  EXPECT_DOUBLE_EQ(report.maxDistance, 2.0);
  EXPECT_EQ(report.maxDistancePosition, vertices[2]);
  EXPECT_GE(report.maxBarycentricDistance, 4.0);
  EXPECT_GT(report.milliseconds, 0.0);
  EXPECT_FALSE(report.unitsDiffer());
  EXPECT_NE(report.describe().find("vertex 2 at (0.5, 0.5, -2)"), std::string::npos) << report.describe();
}

TEST(EmbedReport, NamesNoFarthestVertexWhereNoneIsOutside) {
  const TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  const Points vertices{{0.5, 0.5, 0.5}};
  const std::string text = embedInto(cage, viewOf(vertices)).describe();
  EXPECT_EQ(text.find("1 vertices: 1 inside, 0 outside the cage\n"), 0u) << text;
  EXPECT_EQ(text.find("farthest"), std::string::npos) << text;
}

TEST(EmbedReport, RefusesVerticesBeyondTheLargestDistanceAndNamesTheWorst) {
  const TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  const Points vertices{{0.5, 0.5, 0.5}, {0.25, 1.5, 0.75}, {0.5, 0.5, -1.25}, {1.125, 0.5, 0.5}};
  for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
    Embedding embedding;
    const Fit refused = embedInto(cage, viewOf(vertices), {rule, 1.0}, embedding);
    EXPECT_EQ(refused.status.code, StatusCode::OutsideCage);
    for (const char* mentions : {"vertex 2", "(0.5, 0.5, -1.25)", "1.25 outside", "than the maximum of 1"}) {
      EXPECT_NE(refused.status.message.find(mentions), std::string::npos) << refused.status.message;
    }
    EXPECT_EQ(refused.maxDistanceVertex, 2u);
    EXPECT_EQ(refused.maxDistancePosition, vertices[2]);
    EXPECT_EQ(refused.unbound, 4u);
    EXPECT_EQ(refused.inside + refused.outside, 0u);
    EXPECT_TRUE(embedding.empty());
    const Fit accepted = embedInto(cage, viewOf(vertices), {rule, 1.25}, embedding);
    EXPECT_TRUE(accepted.ok()) << accepted.status.message;
    EXPECT_EQ(accepted.outside, 3u);
    EXPECT_EQ(accepted.unbound, 0u);
    // A limit of 0 allows no vertex outside.
    EXPECT_TRUE(embedInto(cage, viewOf(Points{vertices[0]}), {rule, 0.0}, embedding).ok());
    EXPECT_EQ(embedInto(cage, viewOf(vertices), {rule, 0.0}, embedding).status.code, StatusCode::OutsideCage);
  }
}

TEST(EmbedReport, RestErrorIsSmallInsideAndOutside) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const Points vertices =
      test::randomPoints(2000, {Eigen::Vector3d::Constant(-0.25), Eigen::Vector3d::Constant(1.25)}, 25);
  const Fit report = embedInto(cage, viewOf(vertices));
  EXPECT_GT(report.restErrorMax, 0.0);
  EXPECT_LT(report.restErrorMax, 1e-6);
}

TEST(EmbedReport, ReportSaysWhenMeshAndCageAreInDifferentUnits) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const Points metres = test::randomPoints(200, kSampledBox, 26);
  EXPECT_FALSE(embedInto(cage, viewOf(metres)).unitsDiffer());
  EXPECT_EQ(embedInto(cage, viewOf(metres)).unitsMessage(), "");
  for (const double scale : {1e-3, 0.0254, 39.37, 1e3}) {
    const Points others = test::scaledAndMoved(metres, scale, Eigen::Vector3d::Zero());
    const Fit report = embedInto(cage, viewOf(others));
    EXPECT_TRUE(report.ok());
    EXPECT_TRUE(report.unitsDiffer()) << scale;
    EXPECT_NE(report.unitsMessage().find("different units"), std::string::npos);
    EXPECT_NE(report.describe().find(report.unitsMessage()), std::string::npos);
  }
}

TEST(EmbedReport, ReportSaysWhenMeshAndCageLieApart) {
  const TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  const Points vertices = test::scaledAndMoved(test::randomPoints(10, kSampledBox, 27), 1.0, {5, 0, 0});
  const Fit report = embedInto(cage, viewOf(vertices));
  EXPECT_TRUE(report.unitsDiffer());
  EXPECT_EQ(report.outside, 10u);
}

TEST(EmbedReport, NamesTheLargestWeight) {
  const TetMesh cage = test::singleTet();
  EXPECT_EQ(embedInto(cage, viewOf(Points{{0.2, 0.2, 0.2}})).maxWeight, 1.0);
  EXPECT_EQ(embedInto(cage, viewOf(Points{{0.5, 0.5, -0.5}})).maxWeight, 1.0);
  const Fit report = embedInto(cage, viewOf(Points{{-2.0, -3.0, 0.0}}));
  EXPECT_EQ(report.maxWeight, 6.0);
  EXPECT_EQ(report.reassignedByWeight, 0u);  // there is no other tet
  EXPECT_NE(report.describe().find("largest weight 6"), std::string::npos) << report.describe();
}

TEST(EmbedReport, RefusesBadInputAndLeavesTheEmbeddingAlone) {
  const TetMesh cage = test::latticeCage(1, 1, 1);
  const Points good{{0.5, 0.5, 0.5}};
  Embedding embedding;
  ASSERT_TRUE(embedInto(cage, viewOf(good), {}, embedding).ok());

  const auto fails = [&](const TetMesh& badCage, const Points& vertices, StatusCode code, const char* mentions) {
    const Fit report = embedInto(badCage, viewOf(vertices), {}, embedding);
    EXPECT_EQ(report.status.code, code);
    EXPECT_NE(report.status.message.find(mentions), std::string::npos) << report.status.message;
    EXPECT_EQ(report.unbound, vertices.size());
    EXPECT_EQ(embedding.vertexCount(), 1u);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  fails(cage, {}, StatusCode::Empty, "no vertices");
  fails(cage, {{0, 0, 0}, {0, nan, 0}}, StatusCode::NonFinite, "vertex 1");
  fails(cage, {{0, 0, 0}, {0, -1.01e18, 0}}, StatusCode::NonFinite,
        "vertex 1 of the mesh has a coordinate beyond 1e+18");
  fails({}, good, StatusCode::Empty, "no tets");
  TetMesh bad = cage;
  bad.tets[2][1] = 8;
  fails(bad, good, StatusCode::IndexOutOfRange, "tet 2");
  bad = cage;
  bad.nodes[3].x() = nan;
  fails(bad, good, StatusCode::NonFinite, "node 3");
  bad = cage;
  for (Eigen::Vector3d& p : bad.nodes) p.z() = 0.0;
  fails(bad, good, StatusCode::Degenerate, "flat");
  bad = cage;
  for (Eigen::Vector3d& p : bad.nodes) p *= 1e-20;
  fails(bad, {{1e17, 0, 0}, {0, 0, 0}}, StatusCode::Degenerate, "unit");
  for (Eigen::Vector3d& p : bad.nodes) p *= 1e40;
  fails(bad, good, StatusCode::NonFinite, "node 1 of the cage has a coordinate beyond 1e+18");
}

TEST(EmbedReport, RefusesALargestDistanceThatIsNone) {
  const TetMesh cage = test::latticeCage(1, 1, 1);
  const Points inside{{0.5, 0.5, 0.5}};
  for (const double none : {std::numeric_limits<double>::quiet_NaN(), -1.0, -1e-300}) {
    Embedding embedding;
    const Fit report = embedInto(cage, viewOf(inside), {OutsideRule::Nearest, none}, embedding);
    EXPECT_EQ(report.status.code, StatusCode::InvalidOption) << none;
    EXPECT_NE(report.status.message.find("maxDistance is "), std::string::npos) << report.status.message;
    EXPECT_EQ(report.unbound, 1u);
    EXPECT_TRUE(embedding.empty());
  }
}

/// Points of the boundary, computed from its nodes.
Points onBoundary(const TetMesh& cage) {
  Points points;
  for (const auto& face : boundaryFaces(cage)) {
    const Eigen::Vector3d &a = cage.nodes[face[0]], &b = cage.nodes[face[1]], &c = cage.nodes[face[2]];
    for (const Eigen::Vector3d& p : Points{a, (a + b) / 2.0, (a + b + c) / 3.0, 0.1 * a + 0.2 * b + 0.7 * c}) {
      points.push_back(p);
    }
  }
  return points;
}

TEST(EmbedReport, VerticesComputedToLieOnAFaceAreInside) {
  for (const test::LatticeKind& kind : test::latticeKinds()) {
    for (const Eigen::Vector3d& offset : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1000.1, -3.3, 70.7)}) {
      TetMesh cage = kind.make(4);
      cage.nodes = test::scaledAndMoved(cage.nodes, 0.7, offset);
      for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
        const Fit report = embedInto(cage, viewOf(onBoundary(cage)), {rule, 0.0});
        EXPECT_TRUE(report.ok()) << kind.name << ": " << report.status.message;
        EXPECT_EQ(report.outside, 0u) << kind.name;
        EXPECT_EQ(report.maxDistance, 0.0);
        EXPECT_LT(report.maxBarycentricDistance, 1e-9);
      }
    }
  }
}

TEST(EmbedReport, VerticesAHairOffAFaceAreOutside) {
  const TetMesh cage = test::jittered(test::bodyCentredCage(4, 4, 4, 0.25), 0.05, 3);
  Points vertices;
  for (const auto& face : boundaryFaces(cage)) {
    const Eigen::Vector3d &a = cage.nodes[face[0]], &b = cage.nodes[face[1]], &c = cage.nodes[face[2]];
    vertices.push_back((a + b + c) / 3.0 + 1e-14 * (b - a).cross(c - a).normalized());
  }
  for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
    EXPECT_EQ(embedInto(cage, viewOf(vertices), {rule}).inside, 0u);
  }
}

}  // namespace
}  // namespace tetskin
